"""The parameters with which a renderer's own formula comes nearest to a BRDF."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import scipy.optimize
from jax.flatten_util import ravel_pytree

from brdffit import numerics
from brdffit.exports.deviation import hemisphere, pairs
from brdffit.exports.material import many
from brdffit.models import AbstractBRDF

PAIRS = 1500
ROUGHNESSES = (0.1, 0.2, 0.35, 0.5, 0.7, 0.9)

Parameters = dict[str, Any]
Formula = Callable[[Parameters, Any, Any], Any]


def match(
    brdf: AbstractBRDF,
    formula: Formula,
    starts: Sequence[Parameters],
    bounds: Mapping[str, tuple[float, float]],
) -> Parameters:
    """Fit a formula to a BRDF.

    What is compared is the cube root of ``f_r cos_i``, as the eye would, on directions
    half of which lie in the highlight.

    Args:
        brdf: What to come near to, in RGB.
        formula: ``f_r`` of its parameters and one pair of directions.
        starts: Where to begin; the best is followed.
        bounds: Legal interval of each parameter.
    """
    wi, wo = (jnp.asarray(w, jnp.float32) for w in pairs(PAIRS, seed=1))
    wanted = np.cbrt(np.asarray(many(brdf, wi, wo)) * np.asarray(wi)[:, 2:])
    with jax.enable_x64(True):
        return _solve(formula, starts, bounds, np.asarray(wi), np.asarray(wo), wanted)


def _solve(formula, starts, bounds, wi, wo, wanted) -> Parameters:
    wi, wo, wanted = (jnp.asarray(array, jnp.float64) for array in (wi, wo, wanted))

    def residual(parameters: Parameters) -> jax.Array:
        found = jax.vmap(formula, (None, 0, 0))(parameters, wi, wo)
        return (numerics.cbrt(found * wi[:, 2:]) - wanted).ravel()

    quick = jax.jit(lambda parameters: jnp.sum(residual(parameters) ** 2))
    best = min(starts, key=lambda start: float(quick(start)))
    flat, restore = ravel_pytree({n: jnp.asarray(x, float) for n, x in best.items()})
    lower, upper = (
        np.concatenate(
            [np.full(np.size(best[n]), bounds[n][end]) for n in sorted(best)]
        )
        for end in (0, 1)
    )
    look = jax.jit(lambda x: residual(restore(x)))
    slope = jax.jit(jax.jacfwd(lambda x: residual(restore(x))))
    fit = scipy.optimize.least_squares(
        lambda x: np.asarray(look(x)),
        np.clip(flat, lower, upper),
        jac=lambda x: np.asarray(slope(x)),  # pyright: ignore  (typed as a word)
        bounds=(lower, upper),
        x_scale=upper - lower,
    )
    return jax.tree.map(np.asarray, restore(jnp.asarray(fit.x)))


def colour(brdf: AbstractBRDF) -> np.ndarray:
    """A colour to begin with: roughly the share of light that is reflected."""
    random = np.random.default_rng(0)
    wi, wo = hemisphere(random, (2, PAIRS))
    f_r = np.asarray(many(brdf, jnp.asarray(wi), jnp.asarray(wo)))
    albedo = 4 * np.pi * np.mean(f_r * (wi[:, 2:] * wo[:, 2:]), axis=0)
    return np.clip(albedo, 0.02, 0.98)
