"""The geometry pass: from a scene to samples, without the BRDF.

What a pixel sees and how much light falls there does not depend on the material, so it
is worked out once, in double precision, before anything is shaded or fitted.
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from brdffit.effects import Plan, ambient, bump, cut_out, shadows, tangents
from brdffit.effects.lights import Incident, incident
from brdffit.effects.plan import plan_for_tracing
from brdffit.models.base import RGB
from brdffit.samples import Pixels, Samples, default_channels
from brdffit.scene import Geometry, Hits, Mesh, Scene
from brdffit.types import Values, Vectors


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
        ValueError: The lights have another number of channels, or a style is on, which
            is no measurement of light.
    """
    channels = scene.channels_for(channels)
    plan = plan or plan_for_tracing(scene, channels=channels)
    if plan.on("style"):
        raise ValueError(
            "A picture in the style of the scene shows no reflectance: take `style` "
            "out of the scene, or leave it out of the plan."
        )
    geometry = Geometry(scene.shapes)
    hits = meeting(geometry, plan)(*scene.camera.rays())
    own = [shape.material is not None for shape in scene.shapes]
    hits = hits.take(~np.array(own)[hits.shape])
    return lit(scene, geometry, hits, plan, channels)


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
    light = incident(scene, hits.position, channels, plan.sky, plan.middle)
    reach = None
    if plan.on("shadows"):
        meet = meeting(geometry, plan)
        reach = shadows.visibility(geometry, meet, hits, light, scene)
    elif plan.on("bump") or any(
        isinstance(shape, Mesh) and shape.smooth for shape in scene.shapes
    ):
        reach = shadows.above_horizon(hits, light)
    row, column = np.divmod(hits.ray, scene.camera.shape[1])
    pixels = Pixels(np.zeros_like(row), row, column, (1, *scene.camera.shape))
    glow = None
    if plan.on("ambient"):
        glow = ambient.received(scene, len(row), channels)
    return _samples(
        normal,
        -hits.direction,
        light,
        scene,
        plan.on("tangents"),
        channels,
        pixels,
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
    light = incident(scene, np.zeros((1, 3)), channels, sky=None)
    return _samples(normal, to_viewer, light, scene, True, channels, pixels)


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
    wo, wi = tangents.to_local(normal, to_viewer, light.towards, scene, with_tangents)
    cos_i = np.maximum(wi[..., 2:], 0)
    weight = cos_i * (light.irradiance * scene.exposure)
    if reach is not None:
        weight *= reach[..., None]
    return Samples(
        wi=wi.astype(np.float32),
        wo=wo.astype(np.float32),
        weight=weight.astype(np.float32),
        cosine=np.ones(len(wo), np.float32),
        channels=default_channels(channels),
        pixels=pixels,
        ambient=glow,
    )
