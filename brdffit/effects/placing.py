"""Surface coordinates: where on a map a point of a shape lies."""

import numpy as np
from jaxtyping import Float

from brdffit.scene import Hits, Plane, Sphere
from brdffit.scene.shapes import Shape

Places = Float[np.ndarray, "n 2"]
Vectors = Float[np.ndarray, "n 3"]


def coordinates(shape: Shape, hits: Hits) -> tuple[Places, Vectors, Vectors]:
    """Coordinates ``(u, v)`` of points on one shape, and their gradients.

    The gradients lie in the surface; each says how fast its coordinate grows and where
    to. On a sphere they are 0 at the poles, where longitude has no meaning.
    """
    if isinstance(shape, Sphere):
        x, y, z = ((hits.position - shape.centre) / shape.radius).T
        u, v = np.arctan2(x, -z) / (2 * np.pi), np.arccos(np.clip(y, -1, 1)) / np.pi
        across = np.hypot(x, z)
        safe = np.where(across > 0, across, np.inf)
        nothing = np.zeros_like(x)
        east = np.stack([-z, nothing, x], axis=1) / safe[:, None]
        south = np.stack([x * y / safe, -across, z * y / safe], axis=1)
        along_u = east / (2 * np.pi * shape.radius * safe)[:, None]
        return np.stack([u, v], axis=1), along_u, south / (np.pi * shape.radius)
    if isinstance(shape, Plane):
        first, second = shape.axes
        away = hits.position - shape.point
        place = np.stack([away @ first, away @ second], axis=1)
        ones = np.ones((len(away), 1))
        return place, ones * first, ones * second
    uv = shape.file.uv
    assert uv is not None  # a mesh refuses maps otherwise
    second, third = hits.weights.T[..., None]
    faces = shape.file.faces[hits.triangle]
    a, b, c = np.moveaxis(uv[faces], 1, 0)
    place = a + second * (b - a) + third * (c - a)
    corners = shape.corners[hits.triangle]
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    # gradients of the weights of corners, dual to the edges in their plane
    normal = np.cross(e1, e2)
    square = np.sum(normal * normal, axis=1, keepdims=True)
    dual_1, dual_2 = np.cross(e2, normal) / square, np.cross(normal, e1) / square
    along = [
        (b - a)[:, k : k + 1] * dual_1 + (c - a)[:, k : k + 1] * dual_2 for k in (0, 1)
    ]
    # rows of an image run down, v of a mesh runs up
    flipped = np.stack([place[:, 0], 1 - place[:, 1]], axis=1)
    return flipped, along[0], -along[1]
