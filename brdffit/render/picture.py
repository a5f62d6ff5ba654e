"""Pictures: a scene traced, shaded and put together."""

import dataclasses

import equinox as eqx
import numpy as np

from brdffit.effects import Plan, bump, style
from brdffit.effects.plan import plan_for_tracing
from brdffit.models.base import AbstractBRDF
from brdffit.render import plain
from brdffit.render.geometry_pass import meeting
from brdffit.render.paths import (
    Materials,
    Part,
    by_material,
    materials_of,
    part_values,
    trace_paths,
)
from brdffit.render.shading import compiled_shade
from brdffit.scene import Geometry, Scene
from brdffit.types import Image

PAIRS = 2**21  # of points and directions at once


def render(brdf: AbstractBRDF, scene: Scene, plan: Plan | None = None) -> Image:
    """Linear float32 image of a scene.

    Shapes without a material of their own are made of ``brdf``. The background is 0, or
    the light probe; a pixel is on a shape when its centre is.

    Args:
        brdf: A model.
        scene: Camera, shapes and lights.
        plan: What to simulate; by default what the scene calls for.

    Raises:
        ValueError: The lights, or a material of the scene, have another number of
            channels than the BRDF.
    """
    channels = scene.channels_for(brdf.channels)
    plan = plan or plan_for_tracing(scene, brdf)
    brdf = plan.model(brdf)
    rows, columns = scene.camera.shape
    if plan.on("style"):
        return _drawn(brdf, scene, plan, channels)
    canvas = np.zeros((rows * columns, channels), np.float32)
    at_once = max(PAIRS // max(plan.directions, 1), 1)
    materials = materials_of(scene, brdf)
    geometry = Geometry(scene.shapes)
    if plain.is_plain(scene, geometry, plan):
        _shade_blocks(canvas, materials, scene, geometry, plan)
        return canvas.reshape(rows, columns, channels)
    single = len(materials) == 1 and not plan.directions
    portion = None if single else _power_of_two(at_once)
    for start in range(0, rows * columns, at_once):
        here = slice(start, start + at_once)
        traced = trace_paths(scene, plan, channels, here, geometry, portion)
        for part in traced.parts:
            _add(canvas, part, _values(materials, part))
    return canvas.reshape(rows, columns, channels)


def _shade_blocks(
    canvas: np.ndarray, materials: Materials, scene, geometry, plan
) -> None:
    """Fill in what the pixels of a plain scene see."""
    members = by_material(scene)

    def shade(block: plain.Block) -> None:
        part = canvas[block.pixels]
        for key, shapes in members.items():
            brdf = materials[key]
            mine = True if len(members) == 1 else np.isin(block.shape, shapes)[:, None]
            if np.any(mine) and isinstance(brdf, AbstractBRDF):
                values = np.asarray(compiled_shade(brdf, block.samples))
                np.copyto(part, values[: len(part)], where=mine)

    plain.for_each_block(scene, geometry, plan, canvas.shape[1], shade)


def _power_of_two(number: int) -> int:
    """The largest power of two that is not above a number."""
    return 1 << (number.bit_length() - 1)


def _add(canvas: np.ndarray, part: Part, values: np.ndarray) -> None:
    """Add the values of a part to its pixels."""
    if part.path is None:  # one ray for each pixel
        canvas[part.pixel] = values
        return
    for channel in range(canvas.shape[1]):
        total = np.bincount(part.pixel, values[:, channel], minlength=len(canvas))
        canvas[:, channel] += total.astype(np.float32)


def _values(materials: Materials, part: Part) -> np.ndarray:
    """What a part brings to its pixels."""
    count = len(part.pixel)
    if part.path is not None:
        part = eqx.tree_at(lambda p: p.pixel, part, np.zeros(0, int))
        needed = {
            key: material
            for key, material in materials.items()
            if key == part.material or not isinstance(material, AbstractBRDF)
        }
        return np.asarray(_compiled(needed, part))[:count]
    if part.samples is None:
        return np.asarray(part.radiance)
    brdf = materials[part.material]
    assert isinstance(brdf, AbstractBRDF)  # samples are made of nothing else
    samples = dataclasses.replace(part.samples, pixels=None)
    return np.asarray(compiled_shade(brdf, samples))[:count]


_compiled = eqx.filter_jit(part_values)


def _drawn(brdf: AbstractBRDF, scene: Scene, plan: Plan, channels: int) -> Image:
    """A picture in the style that the scene asks for."""
    geometry = Geometry(scene.shapes)
    hits = meeting(geometry, plan)(*scene.camera.rays())
    normal = bump.normals(geometry, hits) if plan.on("bump") else hits.normal
    own = materials_of(scene, brdf)
    colours = np.zeros((len(scene.shapes), channels))
    for index in range(len(scene.shapes)):
        material = own.get(index, brdf)
        if isinstance(material, AbstractBRDF):
            colours[index] = np.asarray(material.diffuse_reflectance)
    rows, columns = scene.camera.shape
    canvas = np.zeros((rows * columns, channels), np.float32)
    assert scene.style is not None  # or the effect is off
    tones = style.tones(scene.style, scene, hits, normal, colours[hits.shape])
    canvas[hits.ray] = scene.exposure * tones
    image = canvas.reshape(rows, columns, channels)
    if scene.style.outlines:
        image[style.outlines(hits, scene.camera.shape)] = 0
    return image
