r"""The next step of many small fits, within the bounds.

The linear parameters are eliminated, so a step moves the others alone. It is damped by
their second derivatives before the elimination, not after: where a linear parameter can
do nearly all that another does, as a weight of a lobe and its $F_0$, little is left of
the latter, and damped by that little it would run to its bounds while the others are
still far off.
"""

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool

from brdffit.fit.quadratic import minimise_in_boxes
from brdffit.fit.texel_basis import TexelProblem
from brdffit.fit.texel_equations import Entry, Matrix, Sums, Vector, side_by_side


def propose(
    problem: TexelProblem, found: Sums, x: Array, damping: Array
) -> tuple[Array, Array]:
    """The next step ``(solved, texel)``, and the decrease of the cost it promises.

    Args:
        problem: What all texels have in common.
        found: Sums at the point that was reached.
        x: That point ``(n, texel)``.
        damping: Of each texel, relative to the second derivatives.
    """
    solved, places = problem.solved_places, problem.local_places
    gradient, gram, zero = found.gradient, found.gram, jnp.zeros_like(found.cost[0])
    if problem.residual.affine:
        gradient, gram = eliminated(gram, gradient, found.free)
        places = places[len(found.free) :]
    slope, hessian = assembled(gradient, gram, solved, places, zero)
    own = found.gram[len(found.gram) - len(gram) :]
    diagonal = _added([row[-1] for row in own], solved, places, zero)
    eye = jnp.eye(len(solved), dtype=x.dtype)[..., None]
    damped = hessian + eye * (diagonal * damping[None])[None]
    lower, upper = (bound[solved][:, None] for bound in (problem.lower, problem.upper))
    step, _ = minimise_in_boxes(damped, slope, lower - x[solved], upper - x[solved])
    curvature = jnp.sum(hessian * step[None], axis=1)
    return step, -jnp.sum(step * (slope + curvature / 2), axis=0)


def eliminated(
    gram: Matrix, gradient: Vector, free: Bool[Array, "q channel texel"]
) -> tuple[Vector, Matrix]:
    """Gradient and second derivative after the linear parameters were solved.

    Args:
        gram: Second derivative, the linear ones first.
        gradient: First derivative.
        free: Which linear parameters are not on a bound.
    """
    left, matrix = list(gradient), [list(row) for row in gram]
    for k in range(len(free)):
        pivot = matrix[k][k]
        solid = free[k] & (pivot > 8 * jnp.finfo(pivot.dtype).eps * gram[k][k])
        inverse = jnp.where(solid, 1 / jnp.where(solid, pivot, 1), 0)
        for i in range(k + 1, len(left)):
            share = matrix[i][k] * inverse
            left[i] = left[i] - share * left[k]
            for j in range(k + 1, i + 1):
                matrix[i][j] = matrix[i][j] - share * matrix[j][k]
    rest = range(len(free), len(left))
    kept = tuple(tuple(matrix[i][len(free) : i + 1]) for i in rest)
    return tuple(left[i] for i in rest), kept


def assembled(
    gradient: Vector, gram: Matrix, wanted: np.ndarray, places: np.ndarray, zero: Array
) -> tuple[Array, Array]:
    """Equations of all channels, added where they belong.

    Args:
        gradient: Derivatives of each channel.
        gram: Second derivatives of each channel, row by row up to the diagonal.
        wanted: Places that the whole has, in its order.
        places: Place ``(p, channel)`` of each derivative.
        zero: Nothing, for each texel.

    Returns:
        Gradient ``(wanted, texel)`` and second derivative ``(wanted, wanted, texel)``.
    """
    if not len(wanted):
        return jnp.zeros((0, *zero.shape)), jnp.zeros((0, 0, *zero.shape))
    row_of = {place: i for i, place in enumerate(wanted)}
    matrix = [[zero] * len(wanted) for _ in wanted]
    # term by term: ten times faster than to scatter them
    for i, c in np.ndindex(*places.shape):
        row = matrix[row_of[places[i, c]]]
        for j in range(len(places)):
            column, entry = row_of[places[j, c]], gram[max(i, j)][min(i, j)]
            row[column] = row[column] + _of_channel(entry, c)
    vector = _added(gradient, wanted, places, zero)
    return vector, side_by_side([side_by_side(row) for row in matrix])


def _added(
    entries: Sequence[Entry], wanted: np.ndarray, places: np.ndarray, zero: Array
) -> Array:
    """Entries ``(p, channel)`` of all channels, added where they belong."""
    rows = {place: zero for place in wanted}
    for i, c in np.ndindex(*places.shape):
        rows[places[i, c]] = rows[places[i, c]] + _of_channel(entries[i], c)
    return side_by_side(list(rows.values())) if rows else jnp.zeros((0, *zero.shape))


def _of_channel(entry: Entry, channel: int) -> Array:
    """The part of an entry, of which there may be one for all channels."""
    return entry[min(channel, len(entry) - 1)]
