"""Ambient light: a constant that is added to the diffuse part."""

import numpy as np

from brdffit.effects.decision import Decision, View, not_called_for, relative
from brdffit.effects.lights import incident, irradiance
from brdffit.scene import Scene
from brdffit.types import Values

NAME = "ambient"


def decide(view: View) -> Decision:
    """A scene calls for it when an ambient light has radiance."""
    scene = view.scene
    if not scene.ambient.any():
        return not_called_for(NAME, "no ambient light has radiance")
    hits = view.hits
    light = incident(scene.lights, hits.position, view.channels, view.coarse_sky)
    direct = irradiance(light, hits.normal).sum(axis=1) / np.pi
    ambient = np.broadcast_to(scene.ambient, direct.shape)
    return view.judged(
        NAME,
        relative(ambient, direct + ambient),
        2.0 * view.channels,
        "an ambient light has radiance",
    )


def received(scene: Scene, count: int, channels: int) -> Values:
    """What a unit of diffuse reflectance adds to each of ``count`` samples."""
    amount = np.broadcast_to(scene.ambient * scene.exposure, (count, channels))
    return amount.astype(np.float32)
