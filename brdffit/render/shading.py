"""Shading: the value of every sample for a BRDF, the only part that a fit repeats."""

import jax
import jax.numpy as jnp

from brdffit.compiled import compiled
from brdffit.models.base import AbstractBRDF
from brdffit.samples import Samples
from brdffit.types import Values


def shade(brdf: AbstractBRDF, samples: Samples) -> Values:
    """Values ``sum over lights of f_r(wi, wo) weight``, shape ``(sample, channel)``.

    A pure function of JAX arrays: compile it, batch it, take its derivative. Ambient
    light adds to the diffuse part; without any there is no trace of it in the program.
    """

    def value(wi, wo, weight):
        return jnp.sum(jax.vmap(brdf, in_axes=(0, None))(wi, wo) * weight, axis=0)

    values = jax.vmap(value)(samples.wi, samples.wo, samples.weight)
    if samples.ambient is None:
        return values
    return values + samples.ambient * brdf.diffuse_reflectance[None]


compiled_shade = compiled(shade)
