"""The geometry pass of plain scenes: from pixels to samples in one program.

Where no map, mirror, probe or large mesh has a say, what a pixel sees and how light
falls there is one pure function. Compiled as a whole, it writes nothing but samples, in
blocks of pixels that stay in the processor's cache, several of them at once.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from brdffit.compiled import compiled
from brdffit.effects import Plan, ambient, bounces, bump, cut_out, environment, shadows
from brdffit.effects.lights import incident
from brdffit.geometry import dot
from brdffit.processor import cores
from brdffit.render.weights import weighted
from brdffit.samples import Samples, default_channels
from brdffit.scene import Directional, Geometry, Mesh, Point, Scene, ShadowRays
from brdffit.scene.camera import places
from brdffit.scene.hits import LEAST, least_distance
from brdffit.scene.nearest import ROOM, blocked, first_of

SIZES = (262144, 65536, 16384, 1024)  # pixels of a block: few, so few compilations
FEW = 64  # spheres, planes and triangles; lights, each of which adds to the program
OTHERS = (bump.NAME, cut_out.NAME, bounces.NAME, environment.NAME)


class Block(NamedTuple):
    """Pixels in a row, and what they see; weights are 0 where that is nothing.

    Attributes:
        pixels: First and one beyond the last.
        samples: One for each pixel, and more that only fill up.
        shape: Index of the shape that each sees, -1 for none.
    """

    pixels: slice
    samples: Samples
    shape: np.ndarray


def is_plain(scene: Scene, geometry: Geometry, plan: Plan) -> bool:
    """Whether the geometry pass of a scene is one program."""
    mapped = plan.on(shadows.NAME) and not isinstance(scene.shadows, ShadowRays)
    return not (
        mapped
        or any(plan.on(effect) for effect in OTHERS)
        or any(isinstance(shape, Mesh) and shape.smooth for shape in scene.shapes)
        or geometry.large
        or max(len(geometry.owner), len(scene.lights)) > FEW
    )


def for_each_block(
    scene: Scene,
    geometry: Geometry,
    plan: Plan,
    channels: int,
    work: Callable[[Block], None],
) -> None:
    """Trace a plain scene and hand on its blocks, each as soon as it is there."""
    rows, columns = scene.camera.shape
    count, shadowed = rows * columns, plan.on(shadows.NAME)
    lights = sum(isinstance(light, Directional | Point) for light in scene.lights)
    met_at_once = len(geometry.owner) * (max(lights, 1) if shadowed else 1)
    fitting = [n for n in SIZES if n * met_at_once <= ROOM] or [SIZES[-1]]
    size = min((n for n in fitting if n >= count), default=fitting[0])
    field = scene.tangents if plan.on("tangents") else None
    glow = None
    if plan.on(ambient.NAME):
        glow = ambient.received(scene, 1, channels)
    with jax.enable_x64(True):  # on the device once, not with every block
        image, groups, light = jax.tree.map(
            lambda leaf: jax.device_put(np.asarray(leaf)),
            (
                (scene.camera.lens, (float(rows), float(columns))),
                geometry.groups,
                (scene.lights, plan.middle, scene.exposure),
            ),
        )

    def one(start: int) -> None:
        with jax.enable_x64(True):
            begin = np.asarray(float(start))
            seen = _first(image, groups, begin, size=size)
            wi, wo, weight = _lit(
                image,
                groups,
                light,
                begin,
                seen,
                field=field,
                channels=channels,
                shadowed=shadowed,
            )
        primitive = np.asarray(seen.primitive)
        samples = Samples(
            wi=wi,
            wo=wo,
            weight=weight,
            cosine=np.ones(size, np.float32),
            channels=default_channels(channels),
            ambient=None if glow is None else glow * (primitive[:, None] >= 0),
        )
        here = slice(start, min(start + size, count))
        owner = np.where(primitive < 0, -1, geometry.owner[primitive])
        work(Block(here, samples, owner[: here.stop - here.start]))

    one(0)  # which compiles
    with ThreadPoolExecutor(cores()) as pool:
        list(pool.map(one, range(size, count, size)))


class Seen(NamedTuple):
    """What pixels see: distance (0 for nothing), facing normal, primitive (or -1).

    An array for each component: so each is worked out once, and by vectors.
    """

    distance: Array
    normal: tuple[Array, ...]
    primitive: Array


@partial(compiled, static=("size",))
def _first(image, groups, start, size: int) -> Seen:
    """What each pixel of a block sees."""
    lens, shape = image

    def one(pixel):
        origin, direction = lens.ray(*places(shape, pixel))
        met = first_of(groups, origin, direction, least_distance(origin))
        seen = jnp.isfinite(met.distance)
        inside = dot(met.normal, direction) > 0
        normal = [
            jnp.where(seen, jnp.where(inside, -n, n), -d)
            for n, d in zip(met.normal, direction, strict=True)
        ]
        distance = jnp.where(seen, met.distance, 0.0)
        primitive = jnp.where(seen, met.primitive, -1)
        return Seen(distance, tuple(normal), primitive.astype(jnp.int32))

    return jax.vmap(one)(start + jnp.arange(size))


@partial(compiled, static=("field", "channels", "shadowed"))
def _lit(image, groups, light, start, seen: Seen, field, channels, shadowed):
    """Directions and weights of a block of pixels."""
    (lens, shape), (lights, middle, exposure) = image, light
    pixels = start + jnp.arange(len(seen.distance))
    origin, direction = jax.vmap(lambda p: lens.ray(*places(shape, p)))(pixels)
    position = origin + seen.distance[:, None] * direction
    towards = incident(lights, position, channels, None, middle)
    reach = seen.primitive[:, None] >= 0
    if shadowed:
        least, limit = least_distance(position), towards.distance * (1 - LEAST)
        reach &= ~blocked(groups, position, least, towards.towards, limit)
    return weighted(seen.normal, -direction, towards, reach, exposure, field)
