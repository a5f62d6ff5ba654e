r"""Normal equations of many small fits at once, one for each texel.

They have the structure of those of a single fit (`structure`). Sums run over the
observations, entry by entry: small matrices are never multiplied. Single precision
loses nothing that matters, because costs and gradients are sums over residuals, never
differences of large sums.
"""

import functools
import operator
from collections.abc import Sequence

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from brdffit.fit.quadratic import minimise_in_boxes
from brdffit.fit.texel_basis import Observed, TexelProblem, compared, rows

FEW = 32  # so many observations are added one by one

# Entries ``(channel, texel)``, or ``(1, texel)`` where all channels have the same: what
# is done to one does not wait for others, as it would in a single array.
Entry = Float[Array, "_ texel"]
Vector = tuple[Entry, ...]
Matrix = tuple[tuple[Entry, ...], ...]


class Sums(eqx.Module):
    """Sums over the observations of each channel, at one point.

    Attributes:
        linear: Values of the linear parameters.
        free: Which of them are not on a bound.
        cost: Half the sum of squares.
        gradient: Its derivative in each of the linear and the moving parameters.
        gram: Its second (Gauss-Newton) derivative, row by row up to the diagonal.
    """

    linear: Float[Array, "q channel texel"]
    free: Bool[Array, "q channel texel"]
    cost: Float[Array, "channel texel"]
    gradient: Vector
    gram: Matrix


def sums(problem: TexelProblem, seen: Observed, x: Array) -> Sums:
    """Sums at a point ``x (n, texel)``, in solver coordinates.

    Where the residual is affine the linear parameters are those that fit best within
    their bounds; otherwise they are taken from ``x``, like the others.
    """
    basis, slopes = rows(problem, seen, x, derivatives=True)
    if problem.residual.affine:
        (basis, slopes), data = _weighted(seen, (basis, slopes))
        linear, free = _projected(problem, basis, data)
        error = _mixed(linear, basis) - data
    else:
        linear = x[problem.linear_places]
        free = jnp.ones(linear.shape, bool)
        value = _mixed(linear, basis) * seen.weight
        reached, slope = compared(problem, seen.wo, value)
        error = (reached - seen.target) * seen.scale
        factor = slope * seen.scale * seen.weight
        basis, slopes = jax.tree.map(lambda row: row * factor, (basis, slopes))
    tangents = [_mixed(linear, slope) for slope in slopes]
    basis, tangents, error = jax.lax.optimization_barrier((basis, tangents, error))
    jacobian = [*basis[1:], *tangents]
    return Sums(
        linear=linear,
        free=free,
        cost=_sum(error, error) / 2,
        gradient=tuple(_sum(column, error) for column in jacobian),
        gram=_gram(jacobian),
    )


def best_linear(problem: TexelProblem, seen: Observed, x: Array) -> tuple[Array, Array]:
    """Linear parameters ``(q, channel, texel)`` that fit the values best, and the cost.

    For any residual, whose differences are taken to be small. ``x`` is ``(n, texel)``
    or ``(n,)``.
    """
    basis, _ = rows(problem, seen, x, derivatives=False)
    basis, data = _weighted(seen, basis)
    linear, _ = _projected(problem, basis, data)
    error = _mixed(linear, basis) - data
    return linear, jnp.sum(_sum(error, error), axis=0) / 2


def _weighted(seen: Observed, basis):
    """Rows and data times the weight of a difference, worked out before all sums."""
    weight = seen.lean * seen.weight
    weighted = jax.tree.map(lambda row: row * weight, basis)
    return jax.lax.optimization_barrier((weighted, seen.lean * seen.value))


def _projected(problem: TexelProblem, basis, data: Array) -> tuple[Array, Array]:
    """Linear parameters that fit best within their bounds, and which are free."""
    constant, *columns = basis
    places = problem.linear_places
    shape = (*places.shape, data.shape[-1])
    if not columns:
        return jnp.zeros(shape, data.dtype), jnp.zeros(shape, bool)
    lower, upper = (
        jnp.broadcast_to(bound[places][..., None], shape)
        for bound in (problem.lower, problem.upper)
    )

    def wide(entries: Sequence[Entry]) -> Array:
        return side_by_side([jnp.broadcast_to(entry, shape[1:]) for entry in entries])

    error = constant - data
    slope = wide([_sum(column, error) for column in columns])
    gram, every = _gram(columns), range(len(columns))
    hessian = [wide([gram[max(i, j)][min(i, j)] for j in every]) for i in every]
    return minimise_in_boxes(side_by_side(hessian), slope, lower, upper)


def _mixed(linear: Array, basis) -> Array:
    """``C + sum of a_j B_j (channel, observation, texel)``."""
    mixture, *columns = basis
    for value, column in zip(linear, columns, strict=True):
        mixture = mixture + value[:, None] * column
    return mixture


def _sum(first: Array, second: Array) -> Array:
    """Sum of products over the observations, ``(channel or 1, texel)``.

    Term by term where they are few, which is three times as fast as a reduction; and
    shut off from what uses it, lest it be repeated there.
    """
    count = first.shape[1]
    if count > FEW:
        return jax.lax.optimization_barrier(jnp.sum(first * second, axis=1))
    terms = [first[:, i] * second[:, i] for i in range(count)]
    return jax.lax.optimization_barrier(functools.reduce(operator.add, terms))


def _gram(columns: list[Array]) -> Matrix:
    """Sums of products of all pairs of columns, row by row up to the diagonal."""
    return tuple(
        tuple(_sum(column, columns[j]) for j in range(i + 1))
        for i, column in enumerate(columns)
    )


def side_by_side(arrays: Sequence[Array]) -> Array:
    """``jnp.stack``, in a form whose loops over texels XLA keeps free of branches."""
    whole = jnp.zeros((len(arrays), *arrays[0].shape), arrays[0].dtype)
    for i, array in enumerate(arrays):
        whole = jax.lax.dynamic_update_index_in_dim(whole, array, i, 0)
    return whole
