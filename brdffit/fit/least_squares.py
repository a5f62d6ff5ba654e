"""Any residual that JAX can differentiate, through the same solver."""

import dataclasses
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import optimistix as optx
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, PyTree

from brdffit.compiled import compiled
from brdffit.fit.solve import BoundedLevenbergMarquardt, outcome_of
from brdffit.fit.status import CONVERGED, sentence
from brdffit.fit.structure import NormalEquations
from brdffit.fit.uncertainty import uncertainty

RTOL = 1e-14
POLISH = 60  # Gauss-Newton steps at most, to the last digit
DAMPING = 1.0  # cautious: nothing is known of the start
MAX_STEPS = 1000


@dataclasses.dataclass(frozen=True)
class LeastSquares:
    """The outcome of `least_squares`.

    Attributes:
        parameters: Solution, in the structure of the start.
        standard_errors: One standard deviation of each; infinite where undetermined.
        labels: Name of each row of `correlation`.
        correlation: Correlation of the errors.
        at_bound: Sentence per parameter that sits on a bound.
        undetermined: Sentence per parameter that the residual cannot tell.
        cost: Half the sum of squares, weighted by ``sigma`` when it is given.
        residual: The residual at the solution, not weighted.
        converged: True when the solver met its tolerance.
        status: The outcome as a sentence.
        steps: Solver steps.
    """

    parameters: Any
    standard_errors: Any
    labels: tuple[str, ...]
    correlation: np.ndarray
    at_bound: dict[str, str]
    undetermined: dict[str, str]
    cost: float
    residual: np.ndarray
    converged: bool
    status: str
    steps: int


def least_squares(
    residual: Callable[[PyTree], Array],
    start: PyTree,
    bounds: tuple[PyTree, PyTree] | None = None,
    sigma: Array | float | None = None,
    *,
    max_steps: int = MAX_STEPS,
) -> LeastSquares:
    """Minimise half the sum of squares of ``residual(parameters)``.

    Args:
        residual: Function of a pytree of parameters that returns an array.
        start: Where to begin; its structure is that of the parameters.
        bounds: Lower and upper bounds, each a number or in the structure of ``start``.
        sigma: Standard deviations of the residual, when they are known; otherwise its
            variance is estimated from what is left at the solution.
        max_steps: Steps after which to give up.

    Returns:
        The solution in double precision with its errors.

    Raises:
        ValueError: The start lies outside the bounds, or the residual is not finite
            there.
    """
    with jax.enable_x64(True):
        flat, restore = ravel_pytree(jax.tree.map(_double, start))
        lower, upper = (_like(b, start, flat) for b in bounds or (-np.inf, np.inf))
        weight = 1.0 if sigma is None else 1 / jnp.asarray(sigma, float)
        labels = _labels(start)
        outside = ~((flat >= lower) & (flat <= upper))
        if outside.any():
            first = int(np.argmax(outside))
            raise ValueError(
                f"Start `{labels[first]}` must lie in [{lower[first]:g}, "
                f"{upper[first]:g}], but is {flat[first]:g}."
            )

        def weighted(x):
            return jnp.ravel(residual(restore(x)) * weight)

        def equations(x, _):
            r, push = jax.linearize(weighted, x)
            jacobian = jax.vmap(push)(jnp.eye(x.size))
            eps = 8 * jnp.finfo(x.dtype).eps
            cost = jnp.dot(r, r) / 2
            return NormalEquations(
                cost=cost,
                gradient=jacobian @ r,
                hessian=jacobian @ jacobian.T,
                rounding=eps * cost,
                floor=eps**2 * cost,
            )

        if not np.all(np.isfinite(weighted(flat))):
            raise ValueError(
                "The residual must be finite at the start, but is not; begin elsewhere."
            )
        solution = compiled(
            lambda x: optx.least_squares(
                equations,
                BoundedLevenbergMarquardt(RTOL, damping=DAMPING),
                x,
                options={
                    "lower": jnp.asarray(lower),
                    "upper": jnp.asarray(upper),
                    "scale": jnp.where(flat == 0, 1.0, jnp.abs(flat)),
                },
                max_steps=max_steps,
                throw=False,
            )
        )(flat)
        outcome = int(outcome_of(solution.result))
        x = _polished(weighted, np.asarray(solution.value), lower, upper)
        left = np.asarray(residual(restore(jnp.asarray(x))))
        at = compiled(equations)(jnp.asarray(x), None)
        cost, hessian = float(at.cost), np.asarray(at.hessian)
        low, high = x <= lower, x >= upper
        free = x.size - int(np.sum(low | high))
        variance = 1.0 if sigma is not None else 2 * cost / max(left.size - free, 1)
        errors = uncertainty(
            hessian=hessian,
            natural=x,
            slopes=np.ones_like(x),
            widths=np.where(lower < upper, upper - lower, 1.0),
            fixed=lower == upper,
            at_bound=low | high,
            variance=variance,
            labels=labels,
            unseen=x.size * np.finfo(float).eps,
        )
        return LeastSquares(
            parameters=jax.tree.map(np.asarray, restore(jnp.asarray(x))),
            standard_errors=jax.tree.map(
                np.asarray, restore(jnp.asarray(errors.standard_errors))
            ),
            labels=labels,
            correlation=errors.correlation,
            at_bound={
                labels[i]: f"`{labels[i]}` is at its bound {x[i]:g}."
                for i in np.flatnonzero((low | high) & (lower < upper))
                if labels[i] not in errors.undetermined
            },
            undetermined=errors.undetermined,
            cost=cost,
            residual=left,
            converged=outcome == CONVERGED,
            status=f"{sentence(outcome, int(solution.stats['num_steps']))}.",
            steps=int(solution.stats["num_steps"]),
        )


def _polished(weighted: Callable, x: np.ndarray, lower, upper) -> np.ndarray:
    """Gauss-Newton steps by orthogonal factors, which the normal equations square away.

    Components on a bound stay; a step is taken while it is shorter than the last.
    """
    look = compiled(lambda x: (weighted(x), jax.jacfwd(weighted)(x)))
    free, last = (x > lower) & (x < upper), np.inf
    for _ in range(POLISH if free.any() else 0):
        r, jacobian = map(np.asarray, look(jnp.asarray(x)))
        columns = jacobian[:, free]
        size = np.linalg.norm(columns, axis=0)
        size[size == 0] = 1
        step = -np.linalg.lstsq(columns / size, r, rcond=None)[0] / size
        length = np.max(np.abs(step * size))
        if not length < last:
            break
        trial = x.copy()
        trial[free] = np.clip(x[free] + step, lower[free], upper[free])
        x, last = trial, length
    return x


def _double(leaf) -> Array:
    return jnp.asarray(leaf, jnp.float64)


def _like(bound: PyTree, start: PyTree, flat: Array) -> np.ndarray:
    """A bound as a vector, from a number or from the structure of the start."""
    if np.ndim(bound) == 0 and not isinstance(bound, dict):
        return np.full(flat.shape, float(bound))
    spread = jax.tree.map(
        lambda b, s: jnp.broadcast_to(_double(b), jnp.shape(s)), bound, start
    )
    return np.asarray(ravel_pytree(spread)[0])


def _labels(start: PyTree) -> tuple[str, ...]:
    """A name for each number of the start: its path, and its place in an array."""
    labels = []
    for path, leaf in jax.tree_util.tree_leaves_with_path(start):
        name = jax.tree_util.keystr(path, simple=True, separator=".") or "x"
        size = int(np.size(leaf))
        labels += (
            [name] if np.ndim(leaf) == 0 else [f"{name}[{i}]" for i in range(size)]
        )
    return tuple(labels)
