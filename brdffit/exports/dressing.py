"""Parts that the formulas of several renderers share."""

from typing import Any

import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.types import Direction, Scalar

LEAST = 0.001  # alpha; smaller ones are taken for this, as renderers do


def gloss(
    wi: Direction, wo: Direction, roughness: Any, separable: bool = False
) -> tuple[Scalar, Scalar]:
    """``D G / (4 cos_i cos_o)`` of GGX with alpha = roughness^2, and ``cos_d``."""
    wh = bisector(wi, wo)
    alpha = jnp.maximum(jnp.asarray(roughness * roughness, wi.dtype), LEAST)
    d = ndf.ggx(wh, alpha, alpha)
    g = masking_shadowing.smith_ggx(wi, wo, alpha, alpha, separable)
    return d * g, fresnel.cos_d(wh)
