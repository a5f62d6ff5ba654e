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

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from brdffit.fit.basis import Problem, local, over_blocks, rows
from brdffit.fit.blocks import Blocks
from brdffit.fit.quadratic import minimise_in_box, solve_positive
from brdffit.fit.residual import Residual


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


def _transform(residual: Residual, block: Blocks):
    """The transform of a residual on values ``(channel, place)`` of a block."""
    cosines = jnp.asarray(block.cos_i)[None], jnp.asarray(block.cos_o)[None]
    return lambda value: residual.transform(value, *cosines)


def _mixed(linear: Array, basis: Array) -> Array:
    """``C + sum of a_j B_j`` over the last but one axis, for each channel."""
    ones = jnp.ones((linear.shape[0], 1))
    combination = jnp.concatenate([ones, linear], axis=1).astype(basis.dtype)
    return jnp.einsum("cj,c...jp->c...p", combination, basis)


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
        and problem.blocks.weight.shape[2] == problem.blocks.lean.shape[1] == 1
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

    bounds = layout.channel_places(layout.linear)
    parts, linear = jax.vmap(
        lambda g, low, high: _eliminate(g, low, high, q, m, derivatives)
    )(gram, problem.lower[bounds], problem.upper[bounds])
    eps = 8 * jnp.finfo(problem.blocks.wi.dtype).eps
    energy = jnp.sum(gram[:, -1, -1])
    whole = _assemble(parts, local(problem), x.shape[0], eps * energy, eps**2 * energy)
    return whole, linear


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
        mixed = _mixed(linear, found)

        transform = _transform(problem.residual, block)
        predicted = mixed[:, 0]
        compared, slope = jax.jvp(transform, (predicted,), (jnp.ones_like(predicted),))
        error = compared - block.target
        jacobian = jnp.concatenate([found[:, 0, 1:], mixed[:, 1:]], axis=1)
        local = jnp.concatenate([jacobian * slope[:, None], error[:, None]], axis=1)
        magnitude = jnp.sum((slope * predicted * block.scale) ** 2)
        return _gram(local * block.scale[:, None]), magnitude

    start = jnp.zeros((layout.channels, size, size), jnp.float64), jnp.zeros(())
    gram, magnitude = over_blocks(problem, add, start)
    parts = gram[:, -1, -1] / 2, gram[:, :-1, -1], gram[:, :-1, :-1]
    places = layout.channel_places(layout.linear + layout.nonlinear)
    eps = 8 * jnp.finfo(problem.blocks.wi.dtype).eps
    floor = eps**2 * magnitude
    return _assemble(parts, places, x.shape[0], eps * jnp.sum(parts[0]) + floor, floor)


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


def costs(problem: Problem, x: Array, residuals: tuple[Residual, ...]) -> Array:
    """How far off the parameters are under each residual.

    Values that a residual cannot compare are left out of its sums.

    Returns:
        ``(residual, 3)``: half the weighted sum of squares, the unweighted sum of
        squares, and the number of values in it.
    """
    layout = problem.layout
    linear = x[layout.channel_places(layout.linear)]

    def add(block):
        basis = rows(problem, x[problem.nonlinear_places], block, False)
        basis = jnp.broadcast_to(basis, (layout.channels, *basis.shape[1:]))
        predicted = _mixed(linear, basis)
        base = block.lean if block.known_sigma else block.scale
        found = []
        for residual in residuals:
            transform = _transform(residual, block)
            one = jnp.ones_like(block.value)
            target, slope = jax.jvp(transform, (block.value,), (one,))
            use = jnp.broadcast_to(base > 0, predicted.shape) & (slope > 0)
            if residual.positive:
                use &= block.value > 0
            error = jnp.where(use, transform(predicted) - target, 0)
            scale = base / jnp.where(use, slope, 1) if block.known_sigma else base
            tally = (jnp.sum((error * scale) ** 2) / 2, jnp.sum(error**2), jnp.sum(use))
            found.append(jnp.stack(tally))
        return jnp.stack(found)

    return over_blocks(problem, add, jnp.zeros((len(residuals), 3), jnp.float64))
