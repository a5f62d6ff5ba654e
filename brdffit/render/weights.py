"""Weights: what a unit of reflectance adds to a value, and from which directions."""

import jax.numpy as jnp
from jaxtyping import Array

from brdffit.effects import tangents
from brdffit.effects.lights import Incident


def weighted(
    normal, to_viewer, light: Incident, reach, exposure, field: str | None
) -> tuple[Array, Array, Array]:
    """``wi (N, L, 3)``, ``wo (N, 3)`` and ``weight (N, L, C)`` in single precision.

    The weight of a light is its irradiance times the cosine of the incident angle (0
    below the horizon), times the exposure and the reach.

    Args:
        normal: The three components ``(N,)`` of unit normals in the world.
        to_viewer: Unit directions ``(N, 3)``.
        light: What comes towards the points.
        reach: 1 where a light reaches a point, 0 where it is blocked; ``(N, L)``, or an
            axis of 1 where all are alike.
        exposure: Value of a pixel for unit radiance.
        field: As for `tangents.to_local`.
    """
    wo, wi = tangents.to_local(normal, to_viewer, light.towards, field)
    cosine = jnp.maximum(wi[2], 0) * reach
    weight = cosine[..., None] * (light.irradiance * exposure)
    return _together(wi), _together(wo), weight.astype(jnp.float32)


def _together(components: tuple[Array, ...]) -> Array:
    """Vectors in single precision from their components."""
    return jnp.stack([c.astype(jnp.float32) for c in components], axis=-1)
