r"""Shadows by what each light sees first: a square picture, or the faces of a cube.

A point at depth $d$ is in shadow when the picture shows a depth below

$$d - s\,(b_1 \sqrt{1/2}\,\tan\theta + b_0)$$

with $s$ the size of a pixel of the picture at that depth and $\theta$ the angle between
normal and light: the centre of a pixel is at most $s\sqrt{1/2}$ from any point in it,
and a surface goes back by $\tan\theta$ times that.

Source:
    L. Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978; the slope
    in the bias as in OpenGL's polygon offset.
"""

from collections.abc import Callable

import numpy as np

from brdffit.effects.lights import Incident
from brdffit.scene import Geometry, Hits, ShadowMap

COST = 30.0  # operations of one look-up
STEEP = 20.0  # largest tangent that the bias follows

Meet = Callable[[np.ndarray, np.ndarray], Hits]


def visibility(
    geometry: Geometry, meet: Meet, hits: Hits, light: Incident, how: ShadowMap
) -> np.ndarray:
    """1 where a light reaches a point and 0 where it sees something before it.

    The picture of a directional light shows all shapes but endless planes, which are
    in it only where they lie behind others: they take shadows and cast none.
    """
    seen = np.zeros((len(hits.ray), light.towards.shape[1]))
    for index in range(seen.shape[1]):
        towards = np.broadcast_to(light.towards[:, index], hits.position.shape)
        distance = np.broadcast_to(light.distance[:, index], len(towards))
        facing = np.einsum("nk,nk->n", hits.geometric, towards)
        if np.isinf(distance).all():
            shown, depth, pixel = _square(
                meet, hits.position, geometry.outermost, towards[0], how
            )
        else:
            shown, depth, pixel = _cube(meet, hits.position, towards, distance, how)
        cosine = np.clip(facing, 1e-9, 1)
        slope = np.minimum(np.sqrt((1 - cosine) * (1 + cosine)) / cosine, STEEP)
        bias = pixel * (how.slope_bias * np.sqrt(0.5) * slope + how.bias)
        seen[:, index] = (facing > 0) & (shown >= depth - bias)
    return seen


def _square(meet: Meet, position, casters, towards, how: ShadowMap):
    """Depth shown, depth and size of a pixel, for points in parallel light."""
    along = np.eye(3)[int(np.argmin(np.abs(towards)))]
    right = np.cross(along, towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    x, y = position @ right, position @ up
    shown = casters if len(casters) else position
    corners = np.stack([shown @ right, shown @ up])
    low, high = corners.min(axis=1), corners.max(axis=1)
    size = float((high - low).max()) * (1 + 1e-9)
    beside = np.any((x < low[0], x > high[0], y < low[1], y > high[1]), axis=0)
    pixel = size / how.resolution
    column, row = (
        np.clip(((a - b) / pixel).astype(int), 0, how.resolution - 1)
        for a, b in zip((x, y), low, strict=True)
    )
    begin = float((shown @ towards).max()) + size
    centre = (np.arange(how.resolution) + 0.5) * pixel
    grid_y, grid_x = np.meshgrid(low[1] + centre, low[0] + centre, indexing="ij")
    origin = (
        grid_x.reshape(-1, 1) * right + grid_y.reshape(-1, 1) * up + begin * towards
    )
    picture = _depths(meet, origin, np.broadcast_to(-towards, origin.shape))
    depth = picture.reshape(how.resolution, -1)[row, column]
    return np.where(beside, np.inf, depth), begin - position @ towards, pixel


def _cube(meet: Meet, position, towards, distance, how: ShadowMap):
    """Depth shown, depth and size of a pixel, for points around a light."""
    away = -towards
    axis = np.argmax(np.abs(away), axis=1)
    at = np.arange(len(away))
    main = away[at, axis]
    shown = np.full(len(away), np.inf)
    centre = (2 * np.arange(how.resolution) + 1) / how.resolution - 1
    t, s = (a.ravel() for a in np.meshgrid(centre, centre, indexing="ij"))
    source = position + distance[:, None] * towards
    for face in range(6):
        own, sign = face // 2, 1 - 2 * (face % 2)
        here = np.flatnonzero((axis == own) & (np.sign(main) == sign))
        if not len(here):
            continue
        others = [k for k in range(3) if k != own]
        direction = np.empty((len(s), 3))
        direction[:, own] = sign
        direction[:, others[0]], direction[:, others[1]] = s, t
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        origin = np.broadcast_to(source[here[0]], direction.shape)
        picture = _depths(meet, origin, direction).reshape(how.resolution, -1)
        place = away[here][:, others] / np.abs(main[here])[:, None]
        column, row = np.clip(
            ((place + 1) / 2 * how.resolution).astype(int), 0, how.resolution - 1
        ).T
        shown[here] = picture[row, column]
    return shown, distance, 2 * distance / how.resolution


def _depths(meet: Meet, origin, direction) -> np.ndarray:
    """Distance to what each ray meets first."""
    met = meet(origin, direction)
    depth = np.full(len(origin), np.inf)
    depth[met.ray] = met.distance
    return depth
