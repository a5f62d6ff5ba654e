"""A fit without its structure: the plain vector of residuals, for any solver.

For comparison, and for whoever wants another of optimistix's solvers. All parameters
are solved together from a stored Jacobian; a smooth map of the whole line onto each
interval keeps the bounds.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from brdffit.compiled import compiled
from brdffit.fit.basis import Problem
from brdffit.fit.residual import Residual
from brdffit.fit.search import Minima, Search, outcome
from brdffit.fit.transforms import Layout, to_natural, unpack
from brdffit.models import AbstractBRDF
from brdffit.render.shading import shade
from brdffit.samples import Samples

if TYPE_CHECKING:
    import optimistix


def residual_vector(
    layout: Layout,
    brdf: AbstractBRDF,
    samples: Samples,
    use: np.ndarray,
    residual: Residual,
) -> Callable[[Array], Array]:
    """Weighted differences ``T(f) - T(y)`` as a function of solver coordinates.

    Args:
        layout: Parameters of the model.
        brdf: The model; its own values do not matter.
        samples: What to explain.
        use: Which values count; the others give 0.
        residual: What is compared.
    """
    y = jnp.asarray(np.where(use, np.asarray(samples.value), 1), float)
    transform = residual.on(samples)
    target, slope = jax.jvp(transform, (y,), (jnp.ones_like(y),))
    scale = jnp.asarray(use, float)
    if samples.sigma is not None:
        scale /= jnp.where(use, jnp.asarray(samples.sigma) * slope, 1)
    if samples.solid_angle is not None:
        share = np.asarray(samples.solid_angle) / np.mean(samples.solid_angle)
        scale *= np.sqrt(share)[:, None]

    def residuals(x):
        natural = to_natural(layout, x, tuple(range(len(layout.labels))))
        predicted = jnp.asarray(shade(unpack(layout, brdf, natural), samples))
        return (scale * (transform(predicted) - target)).ravel()

    return residuals


def search_plainly(
    residuals: Callable[[Array], Array],
    exact: Problem,
    starts: np.ndarray,
    solver: "optimistix.AbstractLeastSquaresSolver",
    max_steps: int,
) -> Search:
    """Solve from all starts with a solver of optimistix and return the best minimum.

    Args:
        residuals: Function of the solver coordinates.
        exact: The fit, for its bounds.
        starts: Starting points, finite.
        solver: What solves it.
        max_steps: Steps after which a start gives up.
    """
    import optimistix as optx  # slow to import, and seldom needed

    from brdffit.fit.solve import outcome_of

    lower, upper = np.asarray(exact.lower), np.asarray(exact.upper)
    free = np.flatnonzero(upper > lower)
    width = (upper - lower)[free]

    def inside(u):
        x = lower[free] + width * jax.nn.sigmoid(u)
        return jnp.asarray(lower).at[free].set(x)

    share = np.clip((starts[:, free] - lower[free]) / width, 1e-3, 1 - 1e-3)

    def from_start(u):
        found = optx.least_squares(
            lambda u, _: residuals(inside(u)),
            solver,
            u,
            max_steps=max_steps,
            throw=False,
        )
        x = inside(found.value)
        cost = jnp.sum(residuals(x) ** 2) / 2
        return Minima(
            x=x,
            cost=cost,
            rounding=8 * jnp.finfo(cost.dtype).eps * cost,
            steps=found.stats["num_steps"],
            status=outcome_of(found.result),
            origin=jnp.array(0),
        )

    met = compiled(lambda u: jax.lax.map(from_start, u))(np.log(share / (1 - share)))
    met = jax.tree.map(np.asarray, met)
    return outcome(met, len(starts))
