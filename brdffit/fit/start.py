"""Where a fit begins: many starts, spread over the typical ranges of the parameters."""

import numpy as np

from brdffit.fit.transforms import Layout, to_solver


def spread_starts(layout: Layout, count: int) -> np.ndarray:
    """Solver coordinates ``(count, parameters)`` evenly spread over typical ranges.

    Every nonlinear parameter takes equal steps over its range, in the order of an
    additive recurrence with the generalised golden ratio, which fills a box of any
    dimension more evenly than random draws (M. Roberts, "The Unreasonable Effectiveness
    of Quasirandom Sequences", 2018). The channels share one point per start: a start is
    one guess of the material's shape.
    """
    names = layout.nonlinear
    ratio = _generalised_golden_ratio(max(len(names), 1))
    steps = ratio ** -np.arange(1.0, len(names) + 1)
    points = (0.5 + np.outer(np.arange(1, count + 1), steps)) % 1
    # as it stands the recurrence bunches so few points: take their order alone
    points = (points.argsort(axis=0).argsort(axis=0) + 0.5) / max(count, 1)
    low = to_solver(layout, np.array([p.typical[0] for p in layout.known]))
    high = to_solver(layout, np.array([p.typical[1] for p in layout.known]))
    starts = np.tile((low + high) / 2, (count, 1))
    for column, name in enumerate(names):
        for place in layout.places[name]:
            span = high[place] - low[place]
            starts[:, place] = low[place] + points[:, column] * span
    return starts


def _generalised_golden_ratio(dimension: int) -> float:
    """The positive root of ``x**(d + 1) = x + 1``."""
    x = 2.0
    for _ in range(64):
        x = (1 + x) ** (1 / (dimension + 1))
    return x
