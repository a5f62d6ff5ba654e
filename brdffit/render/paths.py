"""Paths: everything that the pixels of a scene see, by what it is made of.

A part of an image is the points of one material, lit, with the way their light takes
to the camera; or a piece of the sky. An image is the sum of its parts.
"""

from collections.abc import Iterator, Mapping

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from brdffit.effects import Plan, bounces, bump
from brdffit.models.base import AbstractBRDF
from brdffit.render.geometry_pass import lit, meeting
from brdffit.render.shading import shade
from brdffit.samples import Samples
from brdffit.scene import Geometry, Glass, Mirror, Scene
from brdffit.types import Index, Values

LEAST = 64  # rays that a part is filled up to, where so many are taken at once
GIVEN = -1  # stands for the material that a scene is rendered with

Materials = Mapping[int, AbstractBRDF | Mirror | Glass]


class Part(eqx.Module):
    """Some of what pixels see.

    Attributes:
        pixel: Pixel of each ray; what comes after them only fills up.
        samples: Points lit, where they have a BRDF; else None.
        radiance: Of the sky, where it is seen; else None.
        path: Bounces on the way, or None where there are none.
        material: Key of the material among those of the scene.
    """

    pixel: Index
    samples: Samples | None
    radiance: Values | None
    path: bounces.Path | None
    material: int = eqx.field(static=True)


class Traced(eqx.Module):
    """The parts of an image of so many pixels and channels."""

    parts: tuple[Part, ...]
    pixels: int = eqx.field(static=True)
    channels: int = eqx.field(static=True)


def materials_of(scene: Scene, brdf: AbstractBRDF) -> Materials:
    """The material of each shape by index, and the one for shapes without."""
    own = {
        index: shape.material
        for index, shape in enumerate(scene.shapes)
        if shape.material is not None
    }
    return {GIVEN: brdf} | own


def trace_paths(
    scene: Scene,
    plan: Plan,
    channels: int,
    rows: slice = slice(None),
    geometry: Geometry | None = None,
    portion: int | None = None,
) -> Traced:
    """Follow the rays of all pixels, or of some of them, to where they end.

    Args:
        scene: Camera, shapes and lights.
        plan: What to simulate.
        channels: Number of channels of the image.
        rows: Which pixels.
        geometry: The shapes, where they have been sorted before.
        portion: Most rays in a part. Smaller parts are filled up with their last ray
            to one of few sizes, so that few programs are compiled. By default parts are
            as large as they are.
    """
    geometry = geometry or Geometry(scene.shapes)
    meet = meeting(geometry, plan)
    origin, direction = scene.camera.rays(rows)
    pixel = np.arange(scene.camera.shape[0] * scene.camera.shape[1])[rows]
    hits = meet(origin, direction)
    missed = hits.missed(len(pixel))
    hits = hits._replace(ray=pixel[hits.ray])
    sky, away, way_to_sky, way = pixel[missed], direction[missed], None, None
    smooth = bounces.smooth_shapes(scene.shapes)
    if plan.on("bounces"):

        def normals(hits):
            return bump.normals(geometry, hits) if plan.on("bump") else hits.normal

        ends = bounces.follow(
            meet, hits, (sky, away), normals, smooth, scene.depth, channels
        )
        hits, way = ends.hits, ends.surface
        sky, away, way_to_sky = ends.pixel, ends.direction, ends.sky
    parts = []
    for key, shapes in by_material(scene).items():
        here = np.flatnonzero(np.isin(hits.shape, shapes))
        if key in smooth or not len(here):
            continue
        for some, count in _portions(here, portion):
            points = hits.take(some)
            samples = lit(scene, geometry, points, plan, channels)
            on_way = None if way is None else way.take(some)
            parts.append(Part(points.ray[:count], samples, None, on_way, key))
    if plan.on("environment") and len(sky):
        assert scene.probe is not None  # or the effect is off
        radiance = scene.exposure * scene.probe.radiance(away)
        radiance = np.broadcast_to(radiance, (len(sky), channels)).astype(np.float32)
        parts.append(Part(sky, None, radiance, way_to_sky, GIVEN))
    return Traced(tuple(parts), scene.camera.shape[0] * scene.camera.shape[1], channels)


def by_material(scene: Scene) -> dict[int, list[int]]:
    """Shapes that share a material, by its key."""
    found: dict[int, list[int]] = {}
    for index, shape in enumerate(scene.shapes):
        found.setdefault(GIVEN if shape.material is None else index, []).append(index)
    return found


def _portions(
    rows: np.ndarray, portion: int | None
) -> Iterator[tuple[np.ndarray, int]]:
    """Rows in portions of the most or of a smaller power of two, and how many count."""
    if portion is None:
        yield rows, len(rows)
        return
    for start in range(0, len(rows), portion):
        some = rows[start : start + portion]
        room = min(LEAST, portion)
        while room < len(some):
            room *= 2
        yield np.pad(some, (0, room - len(some)), mode="edge"), len(some)


def part_values(materials: Materials, part: Part) -> Values:
    """Radiance ``(ray, channel)`` that each ray of a part brings to its pixel."""
    if part.samples is not None:
        brdf = materials[part.material]
        assert isinstance(brdf, AbstractBRDF)  # samples are made of nothing else
        value = shade(brdf, part.samples)
    else:
        value = jnp.asarray(part.radiance)
    if part.path is None:
        return value
    smooth = {k: m for k, m in materials.items() if isinstance(m, Mirror | Glass)}
    return value * bounces.shares(part.path, smooth, value.shape[1])


def radiance(materials: Materials, traced: Traced) -> Float[Array, "pixel channel"]:
    """All pixels, as a pure function of the materials: take its derivative."""
    image = jnp.zeros((traced.pixels, traced.channels))
    for part in traced.parts:
        values = part_values(materials, part)[: len(part.pixel)]
        image = image.at[part.pixel].add(values)
    return image
