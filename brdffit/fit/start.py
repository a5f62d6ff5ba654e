"""Where a fit begins: at the lobe of the data, and spread over typical ranges."""

from collections.abc import Callable

import numpy as np

from brdffit.fit.transforms import Layout, bounds, to_solver
from brdffit.samples import Samples

TILTS = np.geomspace(1e-3, 1, 31)  # edges of bins of the tangent of the half angle
FLAT = 2.0  # a peak lower than this, times the median, is no lobe
HALF_OF_GGX = (np.sqrt(2) - 1) ** 0.5  # tangent at half the peak, in units of alpha

# from the slope that fits the width of a lobe to the parameter that sets it
OF_SLOPE: dict[str, Callable[[float], float]] = {
    "alpha": lambda alpha: alpha,
    "alpha_x": lambda alpha: alpha,
    "alpha_y": lambda alpha: alpha,
    "roughness": np.sqrt,
    "exponent": lambda alpha: 2 / alpha**2,
    "exponent_u": lambda alpha: 2 / alpha**2,
    "exponent_v": lambda alpha: 2 / alpha**2,
}


def starts(
    layout: Layout,
    samples: Samples,
    use: np.ndarray,
    count: int,
    own: np.ndarray | None = None,
) -> np.ndarray:
    """Solver coordinates ``(count, parameters)`` of the points to begin at.

    One has a lobe as wide as that of the data, if they show one and the model has
    a parameter that is known to set a width; the others are spread. Linear parameters
    are NaN: they begin where they fit best, each time.

    Args:
        layout: Parameters of the model.
        samples: What to explain.
        use: Which values count.
        count: Number of starts.
        own: Values to begin at as well, in the order of the layout; they come first.
    """
    if own is not None:
        rest = starts(layout, samples, use, count - 1)
        return np.concatenate([to_solver(layout, own)[None], rest])
    slope = lobe_slope(samples, use)
    shaped = [n for n in layout.nonlinear if n.rpartition(".")[2] in OF_SLOPE]
    if slope is None or not shaped or count == 0:
        found = spread_starts(layout, count)
    else:
        found = np.concatenate([spread_starts(layout, n) for n in (1, count - 1)])
        lower, upper = bounds(layout)
        for name in shaped:
            natural = np.array([p.typical[0] for p in layout.known])
            places = list(layout.places[name])
            natural[places] = OF_SLOPE[name.rpartition(".")[2]](slope)
            found[0, places] = to_solver(layout, natural)[places]
        found[0] = np.clip(found[0], lower, upper)
    found[:, layout.channel_places(layout.linear).ravel()] = np.nan
    return found


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
    low, high = typical_box(layout)
    spread = np.tile((low + high) / 2, (count, 1))
    for column, name in enumerate(names):
        for place in layout.places[name]:
            span = high[place] - low[place]
            spread[:, place] = low[place] + points[:, column] * span
    return spread


def typical_box(layout: Layout) -> tuple[np.ndarray, np.ndarray]:
    """Both ends of the typical ranges, in solver coordinates."""
    return (
        to_solver(layout, np.array([p.typical[0] for p in layout.known])),
        to_solver(layout, np.array([p.typical[1] for p in layout.known])),
    )


def lobe_slope(samples: Samples, use: np.ndarray) -> float | None:
    """The ``alpha`` of a GGX lobe as wide as that of the data, or None without a lobe.

    The width is where the median over half angles, of reflectance times both cosines,
    falls to half of its peak above its level in general.
    """
    brightest = np.argmax(np.sum(samples.weight, axis=2), axis=1)
    rows = np.arange(len(samples))
    wi, wo = np.asarray(samples.wi)[rows, brightest], np.asarray(samples.wo)
    weight = np.sum(samples.weight, axis=(1, 2))
    value = np.where(use, np.nan_to_num(np.asarray(samples.value)), 0).sum(axis=1)
    known = use.all(axis=1) & (weight > 0) & (wi[:, 2] > 0)
    wh = (wi + wo)[known]
    tilt = np.linalg.norm(wh[:, :2], axis=1) / np.maximum(wh[:, 2], 1e-6)
    lobe = (value / np.where(weight > 0, weight, 1) * wi[:, 2] * wo[:, 2])[known]
    bins = np.digitize(tilt, TILTS)
    seen = np.unique(bins)
    level = np.array([np.median(lobe[bins == b]) for b in seen])
    if len(seen) < 2 or not level.max() > FLAT * np.median(level) > 0:
        return None
    peak = int(np.argmax(level))
    half = (level[peak] + np.median(level)) / 2
    below = np.flatnonzero(level[peak:] < half)
    edge = peak + int(below[0]) if len(below) else len(seen) - 1
    return float(TILTS[min(seen[edge], len(TILTS) - 1)] / HALF_OF_GGX)


def _generalised_golden_ratio(dimension: int) -> float:
    """The positive root of ``x**(d + 1) = x + 1``."""
    x = 2.0
    for _ in range(64):
        x = (1 + x) ** (1 / (dimension + 1))
    return x
