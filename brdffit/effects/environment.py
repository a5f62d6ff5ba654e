"""Light of a probe, from as many directions as the tolerance asks for."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from brdffit.catalogue import from_name
from brdffit.effects.bounces import smooth_shapes
from brdffit.effects.decision import (
    Decision,
    View,
    not_called_for,
    operations,
    relative,
)
from brdffit.effects.lights import incident, irradiance
from brdffit.effects.quadrature import Rule, texels
from brdffit.effects.worst import extremes
from brdffit.geometry import any_tangent, shading_frame
from brdffit.models.base import AbstractBRDF

NAME = "environment"
LEAST, MOST = 16, 4096  # directions
TEXELS = 2**17  # most pixels of the probe that all count in the reference
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
    number, error = count(view)
    brdf = _assumed(view)
    w = jnp.array([0.0, 0.0, 1.0])
    cost = number * (operations(brdf, w, w) + 3 * view.channels)
    met = f"they leave an error of {error:.2g}"
    if MARGIN * error > view.tolerance:
        met += f", too near the tolerance or above it: more than {MOST} are needed"
    why = f"there is a light probe, by {number} directions; {met}"
    if view.brdf is None:
        why += f" for {ASSUMED} with its usual values, as the BRDF is not known yet"
    judged = view.judged(NAME, _share(view), cost, why)
    return dataclasses.replace(judged, number=number)


def _share(view: View) -> float:
    """How much of the irradiance comes from the probe; all where it is itself seen."""
    scene, hits = view.scene, view.hits
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


def count(view: View) -> tuple[int, float]:
    """Directions that keep the error within the tolerance, and the error they leave.

    The image is tried at a few points, for the worst BRDF that counts, against every
    pixel of the probe; shadows are not looked at. The number is a power of two, the
    least from which on all meet the tolerance with a margin.
    """
    probe, hits = view.scene.probe, view.hits
    assert probe is not None  # there is no decision to take
    if not len(hits.ray):
        return LEAST, 0.0
    some = hits.take(np.random.default_rng(0).integers(len(hits.ray), size=POINTS))
    points = [np.asarray(a, np.float32) for a in (some.normal, -some.direction)]
    light, direction = texels(probe, TEXELS)
    every = Rule(direction.reshape(-1, 3), light.reshape(-1, light.shape[-1]))
    numbers = 2 ** np.arange(int(np.log2(LEAST)), int(np.log2(MOST)) + 1)
    errors = np.zeros(len(numbers))
    for brdf in extremes(_assumed(view), view.within):
        whole = _wide(every, len(every.towards), view.channels)
        truth = np.asarray(_radiance(brdf, *points, *whole))
        for n, number in enumerate(numbers):
            rule = _wide(view.regions.rule(int(number)), MOST, view.channels)
            found = np.asarray(_radiance(brdf, *points, *rule))
            errors[n] = max(errors[n], relative(found - truth, truth))
    worst_from_here = np.maximum.accumulate(errors[::-1])[::-1]
    good = np.flatnonzero(MARGIN * worst_from_here <= view.tolerance)
    chosen = good[0] if len(good) else len(numbers) - 1
    return int(numbers[chosen]), float(worst_from_here[chosen])


def _wide(rule: Rule, room: int, channels: int) -> list[np.ndarray]:
    """A rule with directions of no weight added, in single precision."""
    short = room - len(rule.towards)
    towards = np.pad(rule.towards, ((0, short), (0, 0)), mode="edge")
    light = np.broadcast_to(rule.irradiance, (len(rule.towards), channels))
    return [
        np.asarray(a, np.float32)
        for a in (towards, np.pad(light, ((0, short), (0, 0))))
    ]


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
