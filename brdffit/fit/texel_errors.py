"""How sure the fit of each texel is, from the second derivative at its solution.

The rules are those of `uncertainty`, without its sentences, in a form that takes many
texels at once.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from brdffit import numerics
from brdffit.fit.texel_basis import TexelProblem
from brdffit.fit.texel_solve import Solved
from brdffit.fit.transforms import to_natural
from brdffit.fit.uncertainty import INVOLVED, WIDE
from brdffit.types import AnyArray

UNSEEN = 1e-6  # share of a variable that others leave, and that is mere rounding


class Found(eqx.Module):
    """The fits of a block in natural units; see `TexelFits`.

    ``enough`` is True where a texel has as many values as unknowns.
    """

    natural: Float[AnyArray, "n texel"]
    standard_errors: Float[AnyArray, "n texel"]
    rms: Float[AnyArray, " texel"]
    at_bound: Bool[AnyArray, " texel"]
    enough: Bool[AnyArray, " texel"]


def examine(problem: TexelProblem, solved: Solved, known_sigma: bool | Array) -> Found:
    """Values, errors and bounds of the points that were reached."""
    x, layout = solved.progress.x, problem.layout
    lower, upper = problem.lower[:, None], problem.upper[:, None]
    places = tuple(range(len(x)))
    natural, slopes = jax.jvp(
        lambda x: to_natural(layout, x.T, places).T, (x,), (jnp.ones_like(x),)
    )
    known = layout.known
    least, most = (
        jnp.array([getattr(p, end) for p in known], x.dtype)[:, None]
        for end in ("lower", "upper")
    )
    natural = jnp.clip(natural, least, most)
    fixed = lower == upper
    on_bound = ~fixed & ((x <= lower) | (x >= upper))
    unknowns = jnp.sum(~fixed)
    free = jnp.sum(~fixed & ~on_bound, axis=0)
    enough = solved.count >= unknowns
    freedom = jnp.maximum(solved.count - free, 1)
    variance = jnp.where(enough, 2 * solved.cost / freedom, jnp.inf)
    variance = jnp.where(known_sigma, 1.0, variance)

    error = spread(solved.hessian, ~fixed & ~on_bound) * numerics.sqrt(variance)[None]
    vague = error > WIDE * (upper - lower)
    error = jnp.where(vague, jnp.inf, error) * jnp.abs(slopes)
    rms = numerics.sqrt(2 * solved.cost / jnp.maximum(solved.count, 1))
    return Found(
        natural=natural,
        standard_errors=jnp.where(fixed, 0.0, error),
        rms=jnp.where(jnp.isfinite(rms), rms, 0.0),
        at_bound=jnp.any(on_bound, axis=0),
        enough=enough,
    )


def spread(
    hessian: Float[Array, "n n texel"], free: Bool[Array, "n texel"]
) -> Float[Array, "n texel"]:
    """Standard errors at unit variance; infinite where nothing is known.

    One that is not free has the error that it would have if it were, and takes no part
    in the errors of the others.

    By the sweep operator (J. H. Goodnight, "A Tutorial on the SWEEP Operator", The
    American Statistician 33(3), 1979): swept on the free ones, the diagonal holds their
    variances, negative, and what of each other variable they do not explain.
    """
    size = len(free)
    index = jnp.arange(size)
    diagonal = hessian[index, index]
    unit = jnp.where(diagonal > 0, jax.lax.rsqrt(jnp.maximum(diagonal, 1e-37)), 0)
    matrix = hessian * unit[:, None] * unit[None]
    swept = jnp.zeros(free.shape, bool)
    for k in range(size):
        pivot = matrix[k, k]
        solid = free[k] & (pivot > UNSEEN)
        inverse = jnp.where(solid, 1 / jnp.where(solid, pivot, 1), 0)
        row = matrix[k] * inverse[None]
        rest = matrix - matrix[:, None, k] * row[None]
        here = (index == k)[:, None]
        rest = jnp.where(here[:, None], row[None], rest)
        rest = jnp.where(here[None], row[:, None], rest)
        rest = jnp.where(here[:, None] & here[None], -inverse[None, None], rest)
        matrix = jnp.where(solid[None, None], rest, matrix)
        swept |= here & solid[None]
    left = matrix[index, index]
    alone = 1 / jnp.where(left > UNSEEN, left, 1)
    variance = jnp.where(swept, -left, jnp.where(left > UNSEEN, alone, jnp.inf))
    # with one that the others explain away, those that do so are as little known
    lost = free & ~swept & (unit > 0)
    parts = (jnp.abs(matrix) > INVOLVED) & lost[None] & swept[:, None]
    variance = jnp.where(jnp.any(parts, axis=1), jnp.inf, variance)
    return jnp.where(unit > 0, numerics.sqrt(variance) * unit, jnp.inf)
