"""First hits: what each ray of a batch meets first, and the surface there."""

import itertools
from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from brdffit.scene import embree
from brdffit.scene.nearest import anything_before, nearest
from brdffit.scene.shapes import Mesh, Plane, Shape, Sphere
from brdffit.types import AnyArray

Vectors = Float[np.ndarray, "n 3"]

LEAST = (
    1e-9  # distance, relative to the coordinates, within which a ray is at its start
)


class Hits(NamedTuple):
    """The rays of a batch that meet something, and the points they meet.

    Attributes:
        ray: Index of each among the rays of the batch.
        shape: Index of the shape met.
        distance: Along the ray.
        position: Point met.
        normal: Unit normal that faces the ray, for shading.
        geometric: Unit normal of the shape itself, on the same side.
        direction: Unit direction of the ray.
        inside: Whether the back of the surface is met, as from within a sphere.
        triangle: Index of the triangle in its mesh, -1 for other shapes.
        weights: Weights of the second and third corner of the triangle.
    """

    ray: Int[np.ndarray, " n"]
    shape: Int[np.ndarray, " n"]
    distance: Float[np.ndarray, " n"]
    position: Vectors
    normal: Vectors
    geometric: Vectors
    direction: Vectors
    inside: Bool[np.ndarray, " n"]
    triangle: Int[np.ndarray, " n"]
    weights: Float[np.ndarray, "n 2"]

    def take(self, rows: np.ndarray) -> "Hits":
        """The hits with these indices, or where a Boolean array is True."""
        return Hits(*(array[rows] for array in self))

    def missed(self, count: int) -> np.ndarray:
        """Indices of the rays, of so many in the batch, that meet nothing."""
        met = np.zeros(count, bool)
        met[self.ray] = True
        return np.flatnonzero(~met)


def least_distance(origin: Any) -> Any:
    """Distance from which on rays ``(..., 3)`` meet something: rounding of a start.

    Origins may be of numpy or of JAX.
    """
    xp = origin.__array_namespace__()
    x, y, z = (abs(origin[..., axis]) for axis in range(3))
    return LEAST * (1 + xp.maximum(xp.maximum(x, y), z))


class Geometry:
    """Shapes as arrays, sorted by kind: spheres, planes, triangles, large meshes.

    A mesh of more than `embree.MANY` triangles is left to Embree.
    """

    def __init__(self, shapes: Sequence[Shape]) -> None:
        """Sort the shapes."""
        self.shapes = tuple(shapes)
        self.large = {
            i: embree.Engine(shape.corners)
            for i, shape in enumerate(shapes)
            if isinstance(shape, Mesh) and len(shape.file.faces) > embree.MANY
        }
        self.groups, owners, triangles = {}, [], []
        for kind in (Mesh, Plane, Sphere):  # as JAX sorts them
            members = [
                i
                for i, shape in enumerate(shapes)
                if isinstance(shape, kind) and i not in self.large
            ]
            if members:
                arrays, counts = _stack([self.shapes[i] for i in members])
                self.groups[kind.__name__] = arrays
                owners.append(np.repeat(members, counts))
                inner = [
                    np.arange(n) if kind is Mesh else np.full(n, -1) for n in counts
                ]
                triangles.append(np.concatenate(inner))
        self.owner = np.concatenate(owners) if owners else np.zeros(0, int)
        self.triangle = np.concatenate(triangles) if owners else np.zeros(0, int)

    def first_hits(self, origin: Vectors, direction: Vectors) -> Hits:
        """What each ray meets first, beyond rounding of its start."""
        least = least_distance(origin)
        found = nearest(self.groups, origin, direction, least, len(self.owner))
        distance, normal, weights = map(
            np.asarray, (found.distance, found.normal, found.weights)
        )
        if len(self.owner):
            shape = self.owner[found.primitive]
            triangle = self.triangle[found.primitive]
        else:
            shape, triangle = (np.zeros(len(origin), int) for _ in range(2))
        for index, engine in self.large.items():
            met = engine.first_hits(origin, direction)
            nearer = met.distance < distance
            distance = np.where(nearer, met.distance, distance)
            shape = np.where(nearer, index, shape)
            triangle = np.where(nearer, met.primitive, triangle)
            normal = np.where(nearer[:, None], met.normal, normal)
            weights = np.where(nearer[:, None], met.weights, weights)
        ray = np.flatnonzero(np.isfinite(distance))
        direction, distance = direction[ray], distance[ray]
        shape, triangle = shape[ray], triangle[ray]
        outward, weights = normal[ray], weights[ray]
        inside = np.einsum("nk,nk->n", outward, direction) > 0
        facing = np.where(inside[:, None], -outward, outward)
        return Hits(
            ray,
            shape,
            distance,
            origin[ray] + distance[:, None] * direction,
            self._smooth(shape, triangle, weights, facing),
            facing,
            direction,
            inside,
            triangle,
            weights,
        )

    def blocked(
        self,
        position: Vectors,
        towards: Float[AnyArray, "#point light 3"],
        distance: Float[AnyArray, "#point light"],
    ) -> Bool[np.ndarray, "point light"]:
        """Whether anything stands between points and lights; a first axis may be 1."""
        least = least_distance(position)
        towards, limit = np.asarray(towards), np.asarray(distance) * (1 - LEAST)
        found = anything_before(
            self.groups, position, towards, limit, least, len(self.owner)
        )
        for engine in self.large.values():
            for light in range(found.shape[1]):
                wide = np.broadcast_to(towards[:, light], position.shape)
                met = np.asarray(engine.first_hits(position, wide).distance)
                found[:, light] |= met < limit[:, light]
        return found

    @cached_property
    def outermost(self) -> Vectors:
        """Points between which all shapes lie that end somewhere."""
        around = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
        found = [np.zeros((0, 3))]
        for shape in self.shapes:
            if isinstance(shape, Sphere):
                found.append(shape.centre + shape.radius * around)
            elif isinstance(shape, Mesh):
                found.append(shape.corners.reshape(-1, 3))
        return np.concatenate(found)

    def _smooth(self, shape, triangle, weights, facing) -> Vectors:
        """Normals interpolated across the triangles of smooth meshes."""
        normal = facing
        for index, mesh in enumerate(self.shapes):
            if isinstance(mesh, Mesh) and mesh.smooth:
                here = shape == index
                corners = mesh.file.normals[mesh.file.faces[triangle[here]]]
                (second, third) = weights[here].T
                all_weights = np.stack([1 - second - third, second, third], axis=1)
                between = np.einsum("nc,nck->nk", all_weights, corners)
                between /= np.linalg.norm(between, axis=1, keepdims=True)
                back = np.einsum("nk,nk->n", between, facing[here]) < 0
                normal = normal.copy()
                normal[here] = np.where(back[:, None], -between, between)
        return normal


def _stack(shapes: Sequence[Any]) -> tuple[tuple[np.ndarray, ...], list[int]]:
    """Shapes of one kind as arrays, and how many primitives each has."""
    first = shapes[0]
    if isinstance(first, Sphere):
        names = ("centre", "radius")
    elif isinstance(first, Plane):
        names = ("point", "normal")
    else:
        corners = [shape.corners for shape in shapes]
        return (np.concatenate(corners),), [len(each) for each in corners]
    arrays = tuple(np.stack([getattr(s, name) for s in shapes]) for name in names)
    return arrays, [1] * len(shapes)
