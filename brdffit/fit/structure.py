r"""Normal equations of a fit, from what the declarations of a model allow.

Everything a solver needs comes out of one small Gram matrix of the rows of `basis` and
the data. Two uses of the same rows:

- `projected`: the residual is affine in the value, so the linear parameters are
  eliminated, with their bounds, and the solver sees only the nonlinear ones (variable
  projection, G. Golub and V. Pereyra, SIAM J. Numer. Anal. 10(2), 1973, in the form of
  L. Kaufman, BIT 15, 1975);
- `streamed`: any residual; the solver sees all parameters, and the Jacobian goes
  block by block into the Gram matrix without ever being stored.
"""

import dataclasses
from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from brdffit import numerics
from brdffit.fit.basis import (
    Problem,
    local,
    mixed,
    over_blocks,
    rows,
    transform_in,
)
from brdffit.fit.blocks import Blocks
from brdffit.fit.quadratic import minimise_in_box, solve_positive
from brdffit.fit.transforms import to_natural
from brdffit.types import AnyArray


class NormalEquations(eqx.Module):
    """Half the sum of squares with its first and (Gauss-Newton) second derivative.

    ``rounding`` is the error that floating point leaves in ``cost``, ``floor`` the
    smallest decrease that the gradient can still promise.
    """

    cost: Float[Array, ""]
    gradient: Float[Array, " n"]
    hessian: Float[Array, "n n"]
    rounding: Float[Array, ""]
    floor: Float[Array, ""]


def _gram(rows: Array) -> Array:
    return rows @ jnp.swapaxes(rows, -1, -2)


def project(problem: Problem, x: Array, derivatives: bool = True):
    """Normal equations in the nonlinear parameters, the linear ones eliminated.

    Returns:
        The equations, and the linear parameters ``(channel, q)`` that go with ``x``.
    """
    layout = problem.layout
    q, m = len(layout.linear), len(layout.nonlinear)
    count = (1 + q) * (1 + m if derivatives else 1)
    channels = layout.channels
    shared = (
        not layout.separate
        and problem.blocks.lights.weight.shape[1] == problem.blocks.lean.shape[1] == 1
    )

    def add(block):
        found = rows(problem, x, block, derivatives)
        if shared:  # one product for all channels
            return _gram(jnp.concatenate([found[0], block.value]) * block.lean)[None]
        found = jnp.broadcast_to(found, (channels, *found.shape[1:]))
        found = jnp.concatenate([found, block.value[:, None]], axis=1)
        return _gram(found * block.lean[:, None])

    size = (1, count + channels) if shared else (channels, count + 1)
    gram = over_blocks(problem, add, jnp.zeros((*size, size[1]), jnp.float64))
    if shared:
        own = [np.append(np.arange(count), count + c) for c in range(channels)]
        gram = jnp.stack([gram[0][np.ix_(i, i)] for i in own])

    places = layout.channel_places(layout.linear)
    eps = 8 * jnp.finfo(problem.blocks.wo.dtype).eps
    energy = jnp.sum(gram[:, -1, -1])
    priors = problem.prior_weight[places], problem.prior_mean[places]
    gram += jax.vmap(partial(_expected, size=gram.shape[-1]))(*priors)
    parts, linear = jax.vmap(
        lambda g, low, high: _eliminate(g, low, high, q, m, derivatives)
    )(gram, problem.lower[places], problem.upper[places])
    whole = _assemble(parts, local(problem), x.shape[0], eps * energy, eps**2 * energy)
    return _with_priors(problem, whole, x, problem.nonlinear_places), linear


def _expected(weight: AnyArray, mean: AnyArray, size: int) -> Array:
    """Gram matrix of the priors of one channel's linear parameters, as observations."""
    one = jnp.eye(len(mean))
    rows = jnp.zeros((len(mean), size)).at[:, 1 : 1 + len(mean)].set(one)
    rows = rows.at[:, -1].set(mean)
    return (rows * weight[:, None]).T @ rows


def _with_priors(
    problem: Problem, equations: NormalEquations, x: Array, places: np.ndarray
) -> NormalEquations:
    """The equations with what priors of the parameters at ``places`` add."""
    if not places.size:
        return equations
    natural, slope = jax.jvp(
        lambda x: to_natural(problem.layout, x, tuple(places.tolist())),
        (x,),
        (jnp.ones_like(x),),
    )
    weight = problem.prior_weight[places]
    away = natural - problem.prior_mean[places]
    return dataclasses.replace(
        equations,
        cost=equations.cost + jnp.sum(weight * away**2) / 2,
        gradient=equations.gradient + weight * away * slope,
        hessian=equations.hessian + jnp.diag(weight * slope**2),
    )


def _eliminate(gram, lower, upper, q: int, m: int, derivatives: bool):
    """Local normal equations of one channel after its linear parameters are solved."""
    basis = gram[1 : 1 + q, 1 : 1 + q]
    slope = gram[1 : 1 + q, 0] - gram[1 : 1 + q, -1]
    if q:
        linear, free = minimise_in_box(basis, slope, lower, upper)
    else:
        linear, free = jnp.zeros(0), jnp.ones(0, bool)
    combination = jnp.concatenate([jnp.ones(1), linear])
    spread = jnp.zeros(gram.shape[0]).at[: 1 + q].set(combination).at[-1].set(-1.0)
    image = gram @ spread
    cost = jnp.dot(spread, image) / 2
    if not (derivatives and m):
        return (cost, jnp.zeros(m), jnp.zeros((m, m))), linear

    # row i of `tangent`: how the residual changes with nonlinear parameter i
    blocks = gram[1 + q : -1].reshape(m, 1 + q, -1)
    tangent = jnp.einsum("j,mjk->mk", combination, blocks)
    gradient = tangent @ spread
    hessian = jnp.einsum(
        "j,amj->am", combination, tangent[:, 1 + q : -1].reshape(m, m, 1 + q)
    )
    # what elimination leaves of a direction the data do not see is mere rounding
    ridge = 64 * jnp.finfo(gram.dtype).eps * jnp.diag(jnp.diagonal(hessian))
    if q:
        held = jnp.where(free[:, None] & free[None, :], basis, jnp.eye(q))
        cross = tangent[:, 1 : 1 + q] * free[None]
        unit = jax.lax.rsqrt(
            jnp.maximum(jnp.diagonal(held), jnp.finfo(gram.dtype).tiny)
        )
        scaled = held * unit[:, None] * unit[None, :]
        scaled += 8 * jnp.finfo(gram.dtype).eps * jnp.eye(q)
        solved = jax.vmap(solve_positive, (None, 0))(scaled, cross * unit[None])
        hessian -= (cross * unit[None]) @ solved.T
    return (cost, gradient, hessian + ridge), linear


def stream(problem: Problem, x: Array) -> NormalEquations:
    """Normal equations in all parameters, for any residual."""
    layout = problem.layout
    q, m = len(layout.linear), len(layout.nonlinear)
    linear = x[layout.channel_places(layout.linear)]
    size = q + m + 1

    def add(block):
        found = rows(problem, x[problem.nonlinear_places], block, True)
        found = jnp.broadcast_to(found, (layout.channels, *found.shape[1:]))
        found = found.reshape(layout.channels, 1 + m, 1 + q, -1)
        value = mixed(linear, found)

        transform = transform_in(block, problem.residual)
        predicted = value[:, 0]
        compared, slope = jax.jvp(transform, (predicted,), (jnp.ones_like(predicted),))
        error = compared - block.target
        jacobian = jnp.concatenate([found[:, 0, 1:], value[:, 1:]], axis=1)
        local = jnp.concatenate([jacobian * slope[:, None], error[:, None]], axis=1)
        magnitude = jnp.sum((slope * predicted * block.scale) ** 2)
        weight, cost = _lost(problem, block, error)
        return _gram(local * (block.scale * weight)[:, None]), cost, magnitude

    matrix = jnp.zeros((layout.channels, size, size), jnp.float64)
    start = matrix, jnp.zeros(layout.channels), jnp.zeros(())
    gram, cost, magnitude = over_blocks(problem, add, start)
    if problem.loss is None:
        cost = gram[:, -1, -1] / 2
    places = layout.channel_places(layout.linear + layout.nonlinear)
    eps = 8 * jnp.finfo(problem.blocks.wo.dtype).eps
    floor = eps**2 * magnitude
    whole = _assemble(
        (cost, gram[:, :-1, -1], gram[:, :-1, :-1]),
        places,
        x.shape[0],
        eps * jnp.sum(cost) + floor,
        floor,
    )
    return _with_priors(problem, whole, x, np.arange(x.shape[0]))


def _lost(problem: Problem, block: Blocks, error: Array) -> tuple[Array, Array]:
    """Weights that a loss gives to errors ``(channel, place)``, and its costs."""
    if problem.loss is None:
        return jnp.ones((), error.dtype), jnp.zeros(error.shape[0])
    share = block.used_share()
    precision = jnp.where(share > 0, block.scale / jnp.where(share > 0, share, 1), 0)
    spread = problem.spread.astype(error.dtype)
    square = (error * precision / spread) ** 2
    cost = jnp.sum(share**2 * problem.loss.rho(square), axis=1) * spread**2 / 2
    return numerics.sqrt(problem.loss.weight(square)), cost


def _assemble(parts, places: np.ndarray, size: int, rounding, floor) -> NormalEquations:
    """Add the equations of all channels where they belong in the whole."""
    cost, gradient, hessian = parts
    whole = jnp.zeros(size).at[places].add(gradient)
    rows, columns = places[:, :, None], places[:, None, :]
    return NormalEquations(
        cost=jnp.sum(cost),
        gradient=whole,
        hessian=jnp.zeros((size, size)).at[rows, columns].add(hessian),
        rounding=rounding,
        floor=floor,
    )
