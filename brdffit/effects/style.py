r"""Gooch's style: cool to warm in place of light and shade, in steps, with outlines.

$$I = \frac{1 - c}{2}\,(k_{blue} + a\,k_d) + \frac{1 + c}{2}\,(k_{yellow} + b\,k_d)
      + s\,(r \cdot v)^p, \qquad c = n \cdot l$$

Source:
    A. Gooch, B. Gooch, P. Shirley, E. Cohen, "A Non-Photorealistic Lighting Model for
    Automatic Technical Illustration", SIGGRAPH 1998, eqs. 2 and 3 (warm towards the
    light, as in its figures).
"""

import numpy as np
from jaxtyping import Float

from brdffit.effects.decision import Decision, View, not_called_for
from brdffit.effects.lights import incident
from brdffit.scene import Directional, Gooch, Hits, Point, Scene

NAME = "style"
COST = 40.0
CREASE = 0.7  # cosine between the normals of neighbours below which a line is drawn
STEEPER = 3.0  # times the steps on its sides that a step of depth is a line
JUMP = 0.03  # step of depth that is a line, relative to the extent of what is seen


def decide(view: View) -> Decision:
    """Called for when it is asked for."""
    if view.scene.style is None:
        return not_called_for(NAME, "no style is asked for")
    return Decision(NAME, True, "it is asked for", 1.0, float(COST), True)


def tones(
    style: Gooch, scene: Scene, hits: Hits, normal, diffuse
) -> Float[np.ndarray, "n channel"]:
    """Colour of points, by the first light that has a place or a direction.

    Args:
        style: Colours and steps.
        scene: Its lights.
        hits: Points that are seen.
        normal: Their normals, with bumps.
        diffuse: Diffuse reflectance ``(N, C)`` of their materials.
    """
    lights = [s for s in scene.lights if isinstance(s, Directional | Point)]
    channels = diffuse.shape[1]
    towards = incident(lights[:1], hits.position, channels, sky=None).towards
    towards = np.broadcast_to(towards[:, 0], normal.shape)
    c = np.einsum("nk,nk->n", normal, towards)
    mix = (1 + c) / 2
    if style.steps:
        mix = (np.minimum(np.floor(mix * style.steps), style.steps - 1) + 0.5) / (
            style.steps
        )
    cool = np.broadcast_to(style.cool, channels) + style.cool_diffuse * diffuse
    warm = np.broadcast_to(style.warm, channels) + style.warm_diffuse * diffuse
    colour = cool + mix[:, None] * (warm - cool)
    if style.highlight:
        back = 2 * c[:, None] * normal - towards
        lobe = np.maximum(-np.einsum("nk,nk->n", back, hits.direction), 0)
        lobe = style.highlight * lobe**style.exponent
        colour = colour + np.where(c > 0, lobe, 0)[:, None]
    return colour


def outlines(hits: Hits, shape: tuple[int, int]) -> np.ndarray:
    """Pixels ``(rows, columns)`` where one shape ends, or a surface jumps or creases.

    ``hits.ray`` are pixels. Of two neighbours the nearer one is drawn, so that a line
    lies on the shape that it bounds; lines are one pixel wide.
    """
    owner = np.full(shape, -1)
    depth = np.full(shape, np.inf)
    normal = np.zeros((*shape, 3))
    place = np.divmod(hits.ray, shape[1])
    owner[place], depth[place], normal[place] = (
        hits.shape,
        hits.distance,
        hits.geometric,
    )
    extent = float(np.ptp(hits.distance)) if len(hits.ray) else 0.0
    drawn = np.zeros(shape, bool)
    for axis in (0, 1):
        here, there = [slice(None)] * 2, [slice(None)] * 2
        here[axis], there[axis] = slice(None, -1), slice(1, None)
        a, b = tuple(here), tuple(there)
        seen = np.isfinite(depth[a]) & np.isfinite(depth[b])
        edge = owner[a] != owner[b]
        edge |= seen & (np.sum(normal[a] * normal[b], axis=-1) < CREASE)
        edge |= seen & _jumps(depth, axis, JUMP * extent)
        nearer = depth[a] <= depth[b]
        drawn[a] |= edge & nearer
        drawn[b] |= edge & ~nearer
    return drawn


def _jumps(depth, axis: int, least: float) -> np.ndarray:
    """Whether a step of depth is large, and much larger than those on its sides."""
    with np.errstate(invalid="ignore"):  # where neither is seen
        step = np.abs(np.diff(depth, axis=axis))
    step = np.where(np.isfinite(step), step, 0)
    none = np.zeros_like(np.take(step, [0], axis=axis))
    before = np.concatenate([none, np.delete(step, -1, axis=axis)], axis=axis)
    after = np.concatenate([np.delete(step, 0, axis=axis), none], axis=axis)
    return step > least + STEEPER * np.maximum(before, after)
