"""Shadows: what stands between a point and a light."""

from collections.abc import Callable
from functools import partial

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from brdffit.effects import cut_out, shadow_map
from brdffit.effects.bounces import smooth_shapes
from brdffit.effects.decision import (
    Decision,
    View,
    not_called_for,
    operations,
    relative,
)
from brdffit.effects.lights import Incident, incident, irradiance
from brdffit.scene import Ambient, Geometry, Hits, Mesh, Scene, ShadowMap, intersection

NAME = "shadows"
PROBE_POINTS = 512  # that are looked at under a light probe
RULE_OF_THREE = 3  # events that may have been missed with 5 % probability

LEAST = 1e-9  # of its distance that a light is nearer than itself

Meet = Callable[[np.ndarray, np.ndarray], Hits]
Visible = Float[np.ndarray, "point light"]


def decide(view: View) -> Decision:
    """A scene calls for it when something stands between a visible point and a light.

    A lone convex shape never does, nor does anything in ambient light, and mirrors and
    glass show none. Otherwise the points of the coarse view are looked at, those behind
    holes, too; where none of ``n`` lies in shadow, a share of 3/n may yet, and its
    error counts unless the view has every pixel.
    """
    scene = view.scene
    if all(isinstance(light, Ambient) for light in scene.lights):
        return not_called_for(NAME, "nothing casts a shadow in ambient light")
    if len(scene.shapes) == 1 and scene.shapes[0].convex:
        return not_called_for(NAME, "a lone convex shape casts no shadow on itself")
    if len(smooth_shapes(scene.shapes)) == len(scene.shapes):
        return not_called_for(NAME, "no shadow shows on mirrors and glass")
    meet, hits = view.geometry.first_hits, cut_out.seen(view)
    if any(shape.opacity is not None for shape in scene.shapes):
        meet = partial(cut_out.first_hits, view.geometry)
    if scene.probe is not None:
        some = np.linspace(0, len(hits.ray) - 1, min(len(hits.ray), PROBE_POINTS))
        hits = hits.take(np.unique(some.astype(int)))
    light = incident(scene.lights, hits.position, view.channels, view.coarse_sky)
    each = irradiance(light, hits.normal)
    seen = by_rays(view.geometry, meet, hits, light)
    dark = ((1 - seen)[..., None] * each).sum(axis=1)
    error = relative(dark, each.sum(axis=1))
    why = "something stands between visible points and a light"
    if error == 0:
        why = f"none of {len(hits.ray)} points looked at lies in shadow"
        if not view.complete or scene.probe is not None:
            error = np.sqrt(RULE_OF_THREE / max(len(hits.ray), 1))
            why += ", but some between them may"
    return view.judged(NAME, error, _cost(scene, light), why)


def _cost(scene: Scene, light: Incident) -> float:
    """Operations of one ray for each light; of a picture, those of its share."""
    ray = jnp.zeros(3), jnp.zeros(3)
    zero = jnp.zeros(())
    of_sphere = operations(intersection.sphere, *ray, jnp.zeros(3), zero, zero)
    of_triangle = operations(intersection.triangle, *ray, jnp.zeros((3, 3)), zero)
    tests = sum(
        of_triangle * len(shape.file.faces) if isinstance(shape, Mesh) else of_sphere
        for shape in scene.shapes
    )
    lights = light.towards.shape[1]
    if isinstance(scene.shadows, ShadowMap):
        rows, columns = scene.camera.shape
        tests = tests * scene.shadows.resolution**2 / (rows * columns) + shadow_map.COST
    return lights * tests


def visibility(
    geometry: Geometry, meet: Meet, hits: Hits, light: Incident, scene: Scene
) -> Visible:
    """1 where a light reaches a point and 0 where something stands before it.

    Args:
        geometry: The shapes.
        meet: What finds first hits, past holes.
        hits: The points.
        light: Light that comes towards them.
        scene: Which says how shadows are found.
    """
    if isinstance(scene.shadows, ShadowMap) and scene.probe is None:
        return shadow_map.visibility(geometry, meet, hits, light, scene.shadows)
    return by_rays(geometry, meet, hits, light)


def above_horizon(hits: Hits, light: Incident) -> Visible:
    """1 where a light is on the side of the surface that is seen, bumps apart."""
    wide = (len(hits.ray), *light.towards.shape[1:])
    towards = np.broadcast_to(light.towards, wide)
    return (np.einsum("nk,nlk->nl", hits.geometric, towards) > 0).astype(float)


def by_rays(geometry: Geometry, meet: Meet, hits: Hits, light: Incident) -> Visible:
    """Visibility by one ray from each point to each light."""
    up = above_horizon(hits, light)
    if meet == geometry.first_hits:
        blocked = geometry.blocked(hits.position, light.towards, light.distance)
        return up * ~blocked
    point, which = np.nonzero(up)
    towards = np.broadcast_to(light.towards, (len(hits.ray), *light.towards.shape[1:]))
    distance = np.broadcast_to(light.distance, up.shape)[point, which]
    met = meet(hits.position[point], towards[point, which])
    nearest = np.full(len(point), np.inf)
    nearest[met.ray] = met.distance
    up[point, which] = nearest >= distance * (1 - LEAST)
    return up
