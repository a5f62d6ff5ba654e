"""Bumps: normals that a height map tilts."""

import numpy as np
from jaxtyping import Float

from brdffit.effects.decision import Decision, View, not_called_for, relative
from brdffit.effects.lights import incident, irradiance
from brdffit.effects.placing import coordinates
from brdffit.scene import Geometry, Hits

NAME = "bump"
COST = 90.0  # two central differences of a bilinear map, and a normal


def decide(view: View) -> Decision:
    """A scene calls for it when a shape has a height map with any slope."""
    maps = [shape.height for shape in view.scene.shapes if shape.height is not None]
    if not maps:
        return not_called_for(NAME, "no shape has a height map")
    if all(np.ptp(height.map.pixels[..., 0]) == 0 for height in maps):
        return not_called_for(NAME, "every height map is level")
    hits = view.hits
    light = incident(view.scene.lights, hits.position, view.channels, view.coarse_sky)
    flat = irradiance(light, hits.normal).sum(axis=1)
    tilted = irradiance(light, normals(view.geometry, hits)).sum(axis=1)
    return view.judged(
        NAME, relative(tilted - flat, tilted), COST, "a shape has a height map"
    )


def normals(geometry: Geometry, hits: Hits) -> Float[np.ndarray, "n 3"]:
    r"""Normals of the bumpy surface, on the side that is seen.

    $$n' \propto n - \frac{\partial h}{\partial u}\nabla u
                   - \frac{\partial h}{\partial v}\nabla v$$

    with the gradients of the surface coordinates along the surface.

    Source:
        J. F. Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978.
    """
    found = hits.normal.copy()
    for index, shape in enumerate(geometry.shapes):
        here = np.flatnonzero(hits.shape == index)
        if shape.height is None or not len(here):
            continue
        part = hits.take(here)
        place, along_u, along_v = coordinates(shape, part)
        by_u, by_v = shape.height.slopes(place, shape.endless).T[..., None]
        uphill = by_u * along_u + by_v * along_v
        # heights count outwards, also where the inside is seen
        outward = np.where(part.inside[:, None], -1.0, 1.0)
        tilted = part.normal - outward * uphill
        found[here] = tilted / np.linalg.norm(tilted, axis=1, keepdims=True)
    return found
