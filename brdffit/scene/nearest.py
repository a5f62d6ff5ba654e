"""What rays meet first among spheres, planes and triangles, in blocks on the device."""

from collections.abc import Mapping
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from brdffit.scene import intersection
from brdffit.types import AnyArray

Groups = Mapping[str, tuple[np.ndarray, ...]]
Rays = Float[np.ndarray, "ray 3"]

BLOCKS = (256, 4096, 65536)  # rays at once: few sizes, so few compilations
POINTS = (4, 64, 1024, 16384)  # points at once, each with all lights
ROOM = 2**22  # most intersections at once


class Meeting(NamedTuple):
    """What rays meet: distance (infinite for a miss), primitive, normal, weights.

    The normal is the outward one, within JAX by components; the weights are those of
    the second and the third corner of a triangle.
    """

    distance: AnyArray
    primitive: AnyArray
    normal: Any
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
            found[here] = np.asarray(_blocked(groups, *arrays))[: size - short]
    return found


def any_of(groups, origin, direction, least, limit) -> Bool[Array, ""]:
    """Whether one ray meets anything before a limit, within JAX."""
    ray = origin, direction
    met = [_DISTANCES[kind](ray, arrays, least) for kind, arrays in groups.items()]
    return jnp.min(jnp.concatenate(met)) < limit


def blocked(groups, position, least, towards, limit) -> Bool[Array, "point light"]:
    """`anything_before` of points that fit at once, within JAX."""

    def alike(array):
        return None if array.shape[0] == 1 < position.shape[0] else 0

    over_lights = jax.vmap(partial(any_of, groups), (None, 0, None, 0))
    axes = (0, alike(towards), 0, alike(limit))
    towards, limit = (a[0] if alike(a) is None else a for a in (towards, limit))
    return jax.vmap(over_lights, axes)(position, towards, least, limit)


_blocked = jax.jit(blocked)


def first_of(groups, origin, direction, least) -> Meeting:
    """What one ray meets first among spheres, planes and triangles, within JAX."""
    found, begin = None, 0
    for kind, arrays in groups.items():
        met = _KINDS[kind]((origin, direction), arrays, least)
        met = met._replace(primitive=met.primitive + begin)
        begin += len(arrays[0])
        found = met if found is None else _nearer(found, met)
    assert found is not None  # nobody asks without shapes
    return found


@jax.jit
def _first(groups, origin, direction, least) -> Meeting:
    """What each ray of a block meets first."""
    met = jax.vmap(partial(first_of, groups))(origin, direction, least)
    return met._replace(normal=jnp.stack(met.normal, axis=1))


def _nearer(one: Meeting, other: Meeting) -> Meeting:
    nearer = other.distance < one.distance
    return jax.tree.map(lambda a, b: jnp.where(nearer, b, a), one, other)


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
    chosen = tuple(component[which] for component in normal)
    return Meeting(distance[which], jnp.asarray(which, int), chosen, jnp.zeros(2))


def _planes(ray, arrays, least) -> Meeting:
    distance = _to_planes(ray, arrays, least)
    which = jnp.argmin(distance) if len(distance) > 1 else 0
    normal = tuple(arrays[1][which])
    return Meeting(distance[which], jnp.asarray(which, int), normal, jnp.zeros(2))


def _triangles(ray, arrays, least) -> Meeting:
    (corners,), (origin, direction) = arrays, ray
    which = jnp.argmin(_to_triangles(ray, arrays, least))
    chosen = corners[which]
    distance, u, v = intersection.triangle(origin, direction, chosen, least)
    normal = tuple(intersection.normal_of(chosen))
    return Meeting(distance, which, normal, jnp.stack([u, v]))


_KINDS = {"Sphere": _spheres, "Plane": _planes, "Mesh": _triangles}
_DISTANCES = {
    "Sphere": lambda *a: _to_spheres(*a)[0],
    "Plane": _to_planes,
    "Mesh": _to_triangles,
}
