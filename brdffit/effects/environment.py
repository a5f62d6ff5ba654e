"""Light of a probe, from as many directions as the tolerance asks for."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from brdffit.catalogue import from_name
from brdffit.effects import cut_out
from brdffit.effects.bounces import smooth_shapes
from brdffit.effects.decision import (
    Decision,
    View,
    not_called_for,
    operations,
    relative,
)
from brdffit.effects.lights import incident, irradiance
from brdffit.effects.quadrature import CUTS, Rule
from brdffit.effects.worst import extremes
from brdffit.geometry import any_tangent, shading_frame
from brdffit.models.base import AbstractBRDF
from brdffit.scene import Hits

NAME = "environment"
LEAST, MOST = 16, 2**17  # directions
BLOCK = 1024  # directions at once: rules of any length are one program
MARGIN = 1.5  # below the tolerance, because few points are looked at
POINTS = 48  # at which quadrature is tried
ASSUMED = "ggx"  # what a surface is made of while its BRDF is not known


def decide(view: View) -> Decision:
    """A scene calls for it when there is a light probe."""
    probe = view.scene.probe
    if probe is None:
        return not_called_for(NAME, "there is no light probe")
    if len(smooth_shapes(view.scene.shapes)) == len(view.scene.shapes):
        why = "there is a light probe, which is seen but lights nothing by itself"
        seen = view.judged(NAME, 1.0, 0.0, why)
        return dataclasses.replace(seen, number=LEAST)
    hits = cut_out.seen(view)
    number, error = count(view, hits)
    brdf = _assumed(view)
    w = jnp.array([0.0, 0.0, 1.0])
    cost = number * (operations(brdf, w, w) + 3 * view.channels)
    met = f"by {number} directions; they leave an error of {error:.2g}"
    if number == view.regions.pixels:
        met = f"by all of its {number} pixels, which leaves no error"
    if MARGIN * error > view.tolerance:
        met += ", too near the tolerance or above it: more pixels of it would be needed"
    why = f"there is a light probe, {met}"
    if view.brdf is None:
        why += f" for {ASSUMED} with its usual values, as the BRDF is not known yet"
    judged = view.judged(NAME, _share(view, hits), cost, why)
    return dataclasses.replace(judged, number=number)


def _share(view: View, hits: Hits) -> float:
    """How much of the irradiance comes from the probe; all where it is itself seen."""
    scene = view.scene
    if len(hits.ray) < len(view.rays[0]) or smooth_shapes(scene.shapes):
        return 1.0
    both, others = (
        irradiance(
            incident(scene.lights, hits.position, view.channels, sky), hits.normal
        )
        for sky in (view.coarse_sky, None)
    )
    whole = both.sum(axis=1)
    return relative(whole - others.sum(axis=1), whole)


def count(view: View, hits: Hits) -> tuple[int, float]:
    """Directions that keep the error within the tolerance, and the error they leave.

    The image is tried at a few points, for the worst BRDF that counts, against every
    pixel of the probe; shadows are not looked at. The number is the least power of two
    that meets the tolerance with a margin, as does the one above it. Where there is
    none, each pixel becomes a direction, which is exact. Probes of more than ``MOST``
    pixels have theirs put together in squares, whose error falls with their area: a
    third of what doubling their sides changes.
    """
    if not len(hits.ray):
        return LEAST, 0.0
    some = hits.take(np.random.default_rng(0).integers(len(hits.ray), size=POINTS))
    points = [np.asarray(a, np.float32) for a in (some.normal, -some.direction)]
    regions, channels = view.regions, view.channels
    brdfs = extremes(_assumed(view), view.within)

    def images(rule: Rule) -> list[np.ndarray]:
        return [_image(brdf, points, rule, channels) for brdf in brdfs]

    truths = images(regions.blocks(MOST))

    def error(rule: Rule) -> float:
        pairs = zip(images(rule), truths, strict=True)
        return max(relative(found - truth, truth) for found, truth in pairs)

    every = min(MOST, regions.pixels)
    number, met = LEAST, None
    while number < every and number <= CUTS:
        left = error(regions.rule(number))
        if MARGIN * left > view.tolerance:
            met = None
        elif met:
            return met[0], max(met[1], left)
        else:
            met = number, left
        number *= 2
    if met:
        return met
    exact = every == regions.pixels
    return every, 0.0 if exact else error(regions.blocks(MOST // 4)) / 3


def _image(brdf, points, rule: Rule, channels: int) -> np.ndarray:
    """Radiance ``(point, channel)`` of points under a rule, block by block.

    The last block is filled up with directions of no weight.
    """
    short = -len(rule.towards) % BLOCK
    light = np.broadcast_to(rule.irradiance, (len(rule.towards), channels))
    towards = np.pad(rule.towards, ((0, short), (0, 0)), mode="edge")
    blocks = [
        np.asarray(array, np.float32).reshape(-1, BLOCK, array.shape[1])
        for array in (towards, np.pad(light, ((0, short), (0, 0))))
    ]
    each = [_radiance(brdf, *points, *block) for block in zip(*blocks, strict=True)]
    return np.sum(each, axis=0, dtype=float)


def _assumed(view: View) -> AbstractBRDF:
    return view.brdf or from_name(ASSUMED, view.channels)


@eqx.filter_jit
def _radiance(brdf, normal, to_viewer, towards, light):
    """Radiance ``(point, channel)`` of points lit from these directions."""

    def point(args):
        normal, to_viewer = args
        frame = shading_frame(normal, any_tangent(normal))
        wi = towards @ frame.T
        f_r = jax.vmap(brdf, (0, None))(wi, frame @ to_viewer)
        return jnp.sum(f_r * light * jnp.maximum(wi[:, 2:], 0.0), axis=0)

    return jax.lax.map(point, (normal, to_viewer))
