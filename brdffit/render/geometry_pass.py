"""The geometry pass: from a scene to samples, without the BRDF.

What a pixel sees and how much light falls there does not depend on the material, so it
is worked out once, in double precision, before anything is shaded or fitted.
"""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.geometry import TANGENTS, shading_frame
from brdffit.models.base import RGB
from brdffit.samples import Pixels, Samples, default_channels
from brdffit.scene import Scene
from brdffit.types import Vectors


def trace(scene: Scene, channels: int | None = None) -> Samples:
    """Samples of all pixels whose centre sees the shape; their value is None.

    Args:
        scene: Camera, shape and lights.
        channels: Number of channels of the image; by default that of the lights, or
            three when each light gives one number.

    Raises:
        ValueError: The lights have another number of channels.
    """
    origin, direction = scene.camera.rays()
    with jax.enable_x64(True):
        distance, normal = _first_hit(scene.shape, origin, direction)
        distance, normal = np.asarray(distance), np.asarray(normal)
    seen = np.isfinite(distance)
    row, column = np.divmod(np.flatnonzero(seen), scene.camera.shape[1])
    frame = np.zeros_like(row)
    pixels = Pixels(frame, row, column, (1, *scene.camera.shape))
    return local_samples(normal[seen], -direction[seen], scene, channels, pixels)


def local_samples(
    normal: Vectors,
    to_viewer: Vectors,
    scene: Scene,
    channels: int | None = None,
    pixels: Pixels | None = None,
) -> Samples:
    """Samples of surface points with known normals, lit as in a scene.

    The weight of a light is its irradiance times the cosine of the incident angle (0
    below the horizon) times the exposure.

    Args:
        normal: Unit normals in the frame of the world.
        to_viewer: Unit directions to the viewer in the same frame.
        scene: Lights, exposure and field of tangents; its camera and shape are not
            looked at.
        channels: As for `trace`.
        pixels: Where the points lie in an image.

    Raises:
        ValueError: The lights have another number of channels.
    """
    channels = channels or scene.channels or RGB
    if scene.channels not in (None, channels):
        raise ValueError(
            f"Lights have {scene.channels} channels, but {channels} are asked for."
        )
    towards = np.stack([light.direction for light in scene.lights])
    with jax.enable_x64(True):
        wo, wi = _to_local(normal, to_viewer, towards, scene.tangents)
        wo, wi = np.asarray(wo), np.asarray(wi)
    irradiance = np.stack(
        [np.broadcast_to(light.irradiance, channels) for light in scene.lights]
    )
    cos_i = np.maximum(wi[..., 2:], 0)
    return Samples(
        wi=wi.astype(np.float32),
        wo=wo.astype(np.float32),
        weight=(cos_i * irradiance * scene.exposure).astype(np.float32),
        cosine=np.ones(len(wo), np.float32),
        channels=default_channels(channels),
        pixels=pixels,
    )


@jax.jit
def _first_hit(shape, origin, direction):
    """Distance ``(N,)`` along each ray, infinite for a miss, and normal ``(N, 3)``."""
    return jax.vmap(shape.intersect)(origin, direction)


@partial(jax.jit, static_argnames="tangents")
def _to_local(normal, to_viewer, towards, tangents):
    """Directions to the viewer ``(N, 3)`` and to all lights ``(N, L, 3)``."""

    def at(normal, to_viewer):
        frame = shading_frame(normal, TANGENTS[tangents](normal))
        return frame @ to_viewer, jnp.matmul(towards, frame.T)

    return jax.vmap(at)(normal, to_viewer)
