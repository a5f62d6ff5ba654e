"""The geometry pass: from a scene to samples, without the BRDF.

What a pixel sees and how much light falls there does not depend on the material, so it
is worked out once, in double precision, before anything is shaded or fitted.
"""

import dataclasses
from collections.abc import Callable
from functools import partial

import jax
import numpy as np

from brdffit.effects import Plan, ambient, bump, cut_out, shadows
from brdffit.effects.lights import Incident, incident
from brdffit.effects.plan import plan_for_tracing
from brdffit.models.base import RGB
from brdffit.render import plain
from brdffit.render.weights import weighted
from brdffit.samples import Pixels, Samples, default_channels
from brdffit.scene import Geometry, Hits, Mesh, Scene
from brdffit.types import Values, Vectors

MOST = 2**28  # pairs of a pixel and a direction, of 24 bytes each


def trace(
    scene: Scene, plan: Plan | None = None, channels: int | None = None
) -> Samples:
    """Samples of all pixels whose centre sees a shape without a material of its own.

    Their value is None. Pixels that see anything else, such as other materials, mirrors
    or the sky, are left out: what they show does not depend on the BRDF that is
    rendered or fitted, or not on it alone.

    Args:
        scene: Camera, shapes and lights.
        plan: What to simulate; by default what the scene calls for.
        channels: Number of channels of the image; by default that of the lights, or
            three when each light gives one number.

    Raises:
        ValueError: The lights have another number of channels; a style is on, which is
            no measurement of light; or pixels and directions of the light probe are too
            many to be kept.
    """
    channels = scene.channels_for(channels)
    plan = plan or plan_for_tracing(scene, channels=channels)
    if plan.on("style"):
        raise ValueError(
            "A picture in the style of the scene shows no reflectance: take `style` "
            "out of the scene, or leave it out of the plan."
        )
    geometry = Geometry(scene.shapes)
    own = np.array([shape.material is not None for shape in scene.shapes])
    if plain.is_plain(scene, geometry, plan):
        return _of_blocks(scene, geometry, plan, channels, own)
    hits = meeting(geometry, plan)(*scene.camera.rays())
    hits = hits.take(~own[hits.shape])
    if len(hits.ray) * plan.directions > MOST:
        raise ValueError(
            f"{len(hits.ray):,} pixels under {plan.directions:,} directions of the "
            f"light probe are more than the {MOST:,} pairs that are kept at once: plan "
            "with a higher tolerance, lower the `resolution` of the camera, or render "
            "instead."
        )
    return lit(scene, geometry, hits, plan, channels)


def _of_blocks(scene, geometry, plan, channels: int, own: np.ndarray) -> Samples:
    """Samples of a plain scene, without pixels that see nothing or ``own`` shapes."""
    parts: dict[int, Samples] = {}

    def keep(block: plain.Block) -> None:
        kept = np.flatnonzero((block.shape >= 0) & ~own[block.shape])
        where = _pixels(kept + block.pixels.start, scene)
        parts[block.pixels.start] = dataclasses.replace(
            jax.tree.map(lambda array: np.asarray(array)[kept], block.samples),
            pixels=where,
        )

    plain.for_each_block(scene, geometry, plan, channels, keep)
    whole = [parts[start] for start in sorted(parts)]
    return jax.tree.map(lambda *arrays: np.concatenate(arrays), *whole)


def meeting(geometry: Geometry, plan: Plan) -> Callable[..., Hits]:
    """What finds first hits: past holes, where there are any."""
    if plan.on("cut_out"):
        return partial(cut_out.first_hits, geometry)
    return geometry.first_hits


def lit(
    scene: Scene, geometry: Geometry, hits: Hits, plan: Plan, channels: int
) -> Samples:
    """Samples of points of a scene; the ``ray`` of a hit is a pixel.

    The weight of a light is its irradiance times the cosine of the incident angle (0
    below the horizon of the surface and of its bumps), times the exposure, and 0 where
    the point lies in shadow.
    """
    normal = bump.normals(geometry, hits) if plan.on("bump") else hits.normal
    light = incident(scene.lights, hits.position, channels, plan.sky, plan.middle)
    reach = None
    if plan.on("shadows"):
        meet = meeting(geometry, plan)
        reach = shadows.visibility(geometry, meet, hits, light, scene)
    elif plan.on("bump") or any(
        isinstance(shape, Mesh) and shape.smooth for shape in scene.shapes
    ):
        reach = shadows.above_horizon(hits, light)
    glow = None
    if plan.on("ambient"):
        glow = ambient.received(scene, len(hits.ray), channels)
    return _samples(
        normal,
        -hits.direction,
        light,
        scene,
        plan.on("tangents"),
        channels,
        _pixels(hits.ray, scene),
        reach,
        glow,
    )


def local_samples(
    normal: Vectors,
    to_viewer: Vectors,
    scene: Scene,
    channels: int | None = None,
    pixels: Pixels | None = None,
) -> Samples:
    """Samples of points with known normals, lit by the distant lights of a scene.

    The weight of a light is its irradiance times the cosine of the incident angle (0
    below the horizon) times the exposure.

    Args:
        normal: Unit normals in the frame of the world.
        to_viewer: Unit directions to the viewer in the same frame.
        scene: Directional lights, exposure and field of tangents; its camera and shapes
            are not looked at.
        channels: As for `trace`.
        pixels: Where the points lie in an image.

    Raises:
        ValueError: The lights have another number of channels.
    """
    channels = scene.channels_for(channels or scene.channels or RGB)
    light = incident(scene.lights, np.zeros((1, 3)), channels, sky=None)
    return _samples(normal, to_viewer, light, scene, True, channels, pixels)


def _pixels(number: np.ndarray, scene: Scene) -> Pixels:
    """Where pixels lie that are counted row by row."""
    row, column = np.divmod(number, scene.camera.shape[1])
    return Pixels(np.zeros_like(row), row, column, (1, *scene.camera.shape))


def _samples(
    normal: Vectors,
    to_viewer: Vectors,
    light: Incident,
    scene: Scene,
    with_tangents: bool,
    channels: int,
    pixels: Pixels | None,
    reach: np.ndarray | None = None,
    glow: Values | None = None,
) -> Samples:
    """Directions and weights in the frame of each point."""
    if reach is None:
        reach = np.ones((1, 1))
    field = scene.tangents if with_tangents else None
    with jax.enable_x64(True):
        components = tuple(normal.T)
        arrays = _compiled(
            components, to_viewer, light, reach, scene.exposure, field=field
        )
        wi, wo, weight = map(np.asarray, arrays)
    return Samples(
        wi=wi,
        wo=wo,
        weight=weight,
        cosine=np.ones(len(wo), np.float32),
        channels=default_channels(channels),
        pixels=pixels,
        ambient=glow,
    )


_compiled = jax.jit(weighted, static_argnames="field")
