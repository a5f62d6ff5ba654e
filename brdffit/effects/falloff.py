"""Distance falloff: light from a point thins out with the square of the distance."""

import numpy as np

from brdffit.effects.decision import Decision, View, not_called_for, relative
from brdffit.scene import Hits, Point

NAME = "falloff"
COST = 12.0  # a difference, its square, a root, two quotients, per light


def decide(view: View) -> Decision:
    """A scene calls for it when there is a point light.

    Leaving it out gives all points the irradiance of their middle; the direction to
    the light stays that of each point.
    """
    lights = [light for light in view.scene.lights if isinstance(light, Point)]
    if not lights:
        return not_called_for(NAME, "there is no point light")
    hits = view.hits
    change, whole = [], []
    for light in lights:
        towards, own, _ = from_point(light, hits.position, view.channels, None)
        _, same, _ = from_point(light, hits.position, view.channels, middle(hits))
        cosine = np.maximum(np.einsum("nk,nlk->nl", hits.normal, towards), 0)[..., None]
        change.append(cosine * (own - same))
        whole.append(cosine * own)
    return view.judged(
        NAME,
        relative(np.concatenate(change), np.concatenate(whole)),
        COST * len(lights),
        "there is a point light",
        "it is so far that all points are as far from it within the tolerance",
    )


def middle(hits: Hits) -> np.ndarray:
    """Middle of the points that are seen; without falloff all are as far as it."""
    return hits.position.mean(axis=0) if len(hits.ray) else np.zeros(3)


def from_point(light: Point, position, channels: int, same) -> tuple:
    """Directions ``(N, 1, 3)``, irradiance ``(N, 1, C)`` and distance ``(N, 1)``.

    The irradiance is ``intensity / distance^2``; with a point ``same``, that of this
    point everywhere. Positions may be of numpy or of JAX.
    """
    xp = position.__array_namespace__()
    away = light.position[None] - position
    distance = xp.sqrt((away * away).sum(axis=1))
    safe = xp.where(distance > 0, distance, 1.0)
    towards = away / safe[:, None]
    if same is None:
        square = xp.where(distance > 0, safe * safe, np.inf)
    else:
        square = xp.sum((light.position - same) ** 2) + 0 * distance
    intensity = xp.broadcast_to(light.intensity, channels)
    return (
        towards[:, None],
        (intensity[None] / square[:, None])[:, None],
        distance[:, None],
    )
