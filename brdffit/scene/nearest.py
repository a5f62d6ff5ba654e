"""What rays meet first among spheres, planes and triangles, in blocks on the device."""

from collections.abc import Mapping
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from brdffit.scene import intersection
from brdffit.types import AnyArray

Groups = Mapping[str, tuple[np.ndarray, ...]]
Rays = Float[np.ndarray, "ray 3"]

BLOCKS = (256, 4096, 65536)  # rays at once: few sizes, so few compilations
POINTS = (4, 64, 1024, 16384)  # points at once, each with all lights
ROOM = 2**22  # most intersections at once


class Meeting(NamedTuple):
    """What rays meet: distance (infinite for a miss), primitive, normal, weights.

    The normal is the outward one; the weights are those of the second and the third
    corner of a triangle.
    """

    distance: AnyArray
    primitive: AnyArray
    normal: AnyArray
    weights: AnyArray


def nearest(
    groups: Groups, origin: Rays, direction: Rays, least: np.ndarray, primitives: int
) -> Meeting:
    """What each ray meets first, in blocks of rays of a few sizes.

    Args:
        groups: Centres and radii of spheres, points and normals of planes, corners of
            triangles, by the name of their class.
        origin: Where rays start.
        direction: Where they go.
        least: Distance from which on something is met.
        primitives: How many there are in all groups.
    """
    count = len(origin)
    nothing = Meeting(
        np.full(count, np.inf),
        np.zeros(count, int),
        np.zeros((count, 3)),
        np.zeros((count, 2)),
    )
    if not groups or not count:
        return nothing
    fitting = [n for n in BLOCKS if n * primitives <= ROOM] or [BLOCKS[0]]
    size = next((n for n in fitting if n >= count), fitting[-1])
    with jax.enable_x64(True):
        for start in range(0, count, size):
            here = slice(start, min(start + size, count))
            short = size - (here.stop - here.start)
            rays = [
                np.pad(a[here], [(0, short)] + [(0, 0)] * (a.ndim - 1), mode="edge")
                for a in (origin, direction, least)
            ]
            met = _first(groups, *rays)
            for whole, part in zip(nothing, met, strict=True):
                whole[here] = np.asarray(part)[: size - short]
    return nothing


def anything_before(
    groups: Groups,
    position: Float[np.ndarray, "point 3"],
    towards: Float[np.ndarray, "#point light 3"],
    limit: Float[np.ndarray, "#point light"],
    least: Float[np.ndarray, " point"],
    primitives: int,
) -> Bool[np.ndarray, "point light"]:
    """Whether rays from points to lights meet anything before a distance.

    ``towards`` and ``limit`` may have a first axis of 1, the same for all points.
    """
    count, lights = len(position), towards.shape[1]
    found = np.zeros((count, lights), bool)
    if not groups or not count:
        return found
    fitting = [n for n in POINTS if n * lights * primitives <= ROOM] or [1]
    size = next((n for n in fitting if n >= count), fitting[-1])
    with jax.enable_x64(True):
        for start in range(0, count, size):
            here = slice(start, min(start + size, count))
            short = size - (here.stop - here.start)

            def part(array, here=here, short=short):
                if len(array) == 1 < count:
                    return array
                pad = [(0, short)] + [(0, 0)] * (array.ndim - 1)
                return np.pad(array[here], pad, mode="edge")

            arrays = (part(a) for a in (position, least, towards, limit))
            found[here] = np.asarray(_any(groups, *arrays))[: size - short]
    return found


@jax.jit
def _any(groups, position, least, towards, limit):
    """Whether anything is met, for a block of points and all lights."""

    def one(origin, least, direction, limit):
        ray = origin, direction
        met = [_DISTANCES[k](ray, a, least) for k, a in groups.items()]
        nearest = jnp.min(jnp.concatenate(met))
        return nearest < limit

    over_lights = jax.vmap(one, (None, None, 0, 0))

    def alike(array):
        return None if array.shape[0] == 1 < position.shape[0] else 0

    axes = (0, 0, alike(towards), alike(limit))
    unwrapped = [
        array[0] if axis is None else array
        for array, axis in zip((towards, limit), axes[2:], strict=True)
    ]
    return jax.vmap(over_lights, axes)(position, least, *unwrapped)


@jax.jit
def _first(groups, origin, direction, least):
    """What each ray of a block meets first among spheres, planes and triangles."""

    def one(origin, direction, least):
        ray = origin, direction
        found, begin = None, 0
        for kind, arrays in groups.items():
            met = _KINDS[kind](ray, arrays, least)
            met = met._replace(primitive=met.primitive + begin)
            begin += len(arrays[0])
            found = met if found is None else _nearer(found, met)
        return found

    return jax.vmap(one)(origin, direction, least)


def _nearer(one: Meeting, other: Meeting) -> Meeting:
    nearer = other.distance < one.distance
    return Meeting(*(jnp.where(nearer, b, a) for a, b in zip(one, other, strict=True)))


def _to_spheres(ray, arrays, least):
    origin, direction = ray

    def one(centre, radius):
        return intersection.sphere(origin, direction, centre, radius, least)

    return jax.vmap(one)(*arrays)


def _to_planes(ray, arrays, least):
    origin, direction = ray

    def one(point, normal):
        return intersection.plane(origin, direction, point, normal, least)

    return jax.vmap(one)(*arrays)


def _to_triangles(ray, arrays, least):
    origin, direction = ray

    def one(corners):
        return intersection.triangle(origin, direction, corners, least)[0]

    return jax.vmap(one)(*arrays)


def _spheres(ray, arrays, least) -> Meeting:
    distance, normal = _to_spheres(ray, arrays, least)
    which = jnp.argmin(distance) if len(distance) > 1 else 0
    return Meeting(
        distance[which], jnp.asarray(which, int), normal[which], jnp.zeros(2)
    )


def _planes(ray, arrays, least) -> Meeting:
    distance = _to_planes(ray, arrays, least)
    which = jnp.argmin(distance) if len(distance) > 1 else 0
    return Meeting(
        distance[which], jnp.asarray(which, int), arrays[1][which], jnp.zeros(2)
    )


def _triangles(ray, arrays, least) -> Meeting:
    (corners,), (origin, direction) = arrays, ray
    which = jnp.argmin(_to_triangles(ray, arrays, least))
    chosen = corners[which]
    distance, u, v = intersection.triangle(origin, direction, chosen, least)
    return Meeting(distance, which, intersection.normal_of(chosen), jnp.stack([u, v]))


_KINDS = {"Sphere": _spheres, "Plane": _planes, "Mesh": _triangles}
_DISTANCES = {
    "Sphere": lambda *a: _to_spheres(*a)[0],
    "Plane": _to_planes,
    "Mesh": _to_triangles,
}
