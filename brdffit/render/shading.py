"""Shading: the value of every sample for a BRDF, the only part that a fit repeats."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models.base import AbstractBRDF
from brdffit.render.geometry_pass import trace
from brdffit.samples import Samples
from brdffit.scene import Scene
from brdffit.types import Image, Values


def shade(brdf: AbstractBRDF, samples: Samples) -> Values:
    """Values ``sum over lights of f_r(wi, wo) weight``, shape ``(sample, channel)``.

    A pure function of JAX arrays: compile it, batch it, take its derivative.
    """

    def value(wi, wo, weight):
        return jnp.sum(jax.vmap(brdf, in_axes=(0, None))(wi, wo) * weight, axis=0)

    return jax.vmap(value)(samples.wi, samples.wo, samples.weight)


def render(brdf: AbstractBRDF, scene: Scene) -> Image:
    """Linear float32 image of a scene whose shape is made of ``brdf``.

    The background is 0; a pixel is on the shape when its centre is.

    Raises:
        ValueError: The lights have another number of channels than the BRDF.
    """
    samples = trace(scene, brdf.channels)
    assert samples.pixels is not None  # for the type checker
    return samples.pixels.images(
        np.asarray(compiled_shade(brdf, samples)), background=0.0
    )[0]


compiled_shade = eqx.filter_jit(shade)
