"""Cut-outs: holes where an opacity map falls below its threshold."""

import numpy as np

from brdffit.effects.decision import Decision, View, not_called_for
from brdffit.effects.placing import coordinates
from brdffit.scene import Geometry, Hits

NAME = "cut_out"
COST = 40.0  # a bilinear map, and another intersection behind each hole
LAYERS = 64  # of holes behind each other before a ray is given up


def decide(view: View) -> Decision:
    """A scene calls for it when a shape has an opacity map below its threshold."""
    maps = [shape.opacity for shape in view.scene.shapes if shape.opacity is not None]
    if not maps:
        return not_called_for(NAME, "no shape has an opacity map")
    if all((m.map.pixels[..., 0] >= m.threshold).all() for m in maps):
        return not_called_for(NAME, "no opacity map falls below its threshold")
    hits = view.hits
    holes = ~solid(view.geometry, hits)
    share = holes.mean() if len(holes) else 0.0
    why = "a shape has holes (error: root of the share of pixels that see one)"
    decision = view.judged(NAME, np.sqrt(share), COST, why)
    if share == 0:  # a hole that no pixel sees may still let light through
        error = 1.0 if len(view.scene.shapes) > 1 else 0.0
        return view.judged(NAME, error, COST, "a shape has holes that light may pass")
    return decision


def solid(geometry: Geometry, hits: Hits) -> np.ndarray:
    """Whether there is a surface where a ray meets a shape."""
    found = np.ones(len(hits.ray), bool)
    for index, shape in enumerate(geometry.shapes):
        here = np.flatnonzero(hits.shape == index)
        if shape.opacity is not None and len(here):
            place, _, _ = coordinates(shape, hits.take(here))
            found[here] = shape.opacity.solid(place, shape.endless)
    return found


def seen(view: View) -> Hits:
    """What the pixels of a view see, past holes."""
    if all(shape.opacity is None for shape in view.scene.shapes):
        return view.hits
    return first_hits(view.geometry, *view.rays)


def first_hits(geometry: Geometry, origin, direction) -> Hits:
    """First hits of rays that go on through holes."""
    begin, ray = np.array(origin), np.arange(len(origin))
    passed = np.zeros(len(origin))
    parts = []
    for _ in range(LAYERS):
        hits = geometry.first_hits(begin, direction[ray])
        full = solid(geometry, hits)
        met = hits.take(full)
        parts.append(
            met._replace(ray=ray[met.ray], distance=met.distance + passed[ray[met.ray]])
        )
        on = hits.take(~full)
        if not len(on.ray):
            break
        passed[ray[on.ray]] += on.distance
        ray, begin = ray[on.ray], on.position
    together = Hits(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))
    return together.take(np.argsort(together.ray, kind="stable"))
