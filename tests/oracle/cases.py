"""Pairs of directions and parameters at which package and oracle are compared.

All numbers are exact in single precision, so that both see the same input.
"""

import zlib

import numpy as np

from brdffit.models import MODELS
from brdffit.parameters import parameters

REGULAR = 16

# what hides behind small differences: normal, mirror, retro, grazing, beyond
HARD = {
    "both along the normal": ((0, 0, 1), (0, 0, 1)),
    "one along the normal": ((0, 0, 1), (0.6, 0.0, 0.8)),
    "a hair from the normal": ((1e-6, 0, 1), (0, 2e-6, 1)),
    "mirror": ((0.48, 0.36, 0.8), (-0.48, -0.36, 0.8)),
    "a hair from the mirror": ((0.48, 0.36, 0.8), (-0.48005, -0.36, 0.79997)),
    "a degree from the mirror": ((0.8, 0.0, 0.6), (-0.79, 0.02, 0.6128)),
    "retro": ((0.36, 0.48, 0.8), (0.36, 0.48, 0.8)),
    "grazing mirror": ((0.8, 0.6, 1e-3), (-0.8, -0.6, 1e-3)),
    "grazing, nearly mirror": ((1, 0, 1e-3), (-0.9999, 0.01, 2e-3)),
    "grazing retro": ((0.8, 0.6, 1e-4), (0.8, 0.6, 1e-4)),
    "grazing, side by side": ((1, 0, 1e-3), (0, 1, 2e-3)),
    "a micron above the horizon": ((0.6, -0.8, 1e-6), (-0.600001, 0.799999, 2e-6)),
    "grazing in, steep out": ((0.6, 0.8, 1e-6), (0.28, 0.0, 0.96)),
    "on the horizon": ((1, 0, 0), (0, 0.6, 0.8)),
    "below the horizon": ((0.6, 0, 0.8), (0, 0.6, -0.8)),
}


def unit(w):
    """``w`` normalised in double, then rounded to single precision."""
    w = np.asarray(w, np.float64)
    return (w / np.linalg.norm(w)).astype(np.float32)


def draw(random, known, name):
    low, high = known.typical
    if name == "exponent":
        low = 1.0
    if known.logarithmic:
        return np.float32(np.exp(random.uniform(np.log(low), np.log(high))))
    return np.float32(random.uniform(low, high))


def everyday(name, random):
    """Parameters of a model, drawn from their typical ranges."""
    drawn = {p: draw(random, k, p) for p, k in parameters(MODELS[name]).items()}
    if name == "he":
        drawn["wavelengths"] = np.float32(random.uniform(0.4, 0.7))
    return drawn


def extreme(name, edge):
    """Parameters of a model, all at their lower or all at their upper bound."""
    known = parameters(MODELS[name])
    corner = {p: np.float32(getattr(k, edge)) for p, k in known.items()}
    if name == "he":
        corner["wavelengths"] = np.float32(0.55)
    return corner


def around_mirror(wi, spread, random):
    """A direction whose half vector with ``wi`` leans from the normal by ``spread``."""
    slope = spread * random.normal(size=2)
    h = unit((*slope, 1.0)).astype(np.float64)
    return 2 * (wi @ h) * h - wi


def cases(name):
    """Everyday pairs, half of them within a highlight, and every hard pair thrice."""
    random = np.random.default_rng(zlib.crc32(name.encode()))
    found = []
    while len(found) < REGULAR:
        wi, wo = (unit(random.normal(size=3)) for _ in range(2))
        if len(found) % 2:
            wo = unit(around_mirror(wi, 10 ** random.uniform(-2, -0.5), random))
        if min(wi[2], wo[2]) > 0.05:
            found.append((everyday(name, random), wi, wo))
    for wi, wo in HARD.values():
        for chosen in (
            everyday(name, random),
            extreme(name, "lower"),
            extreme(name, "upper"),
        ):
            found.append((chosen, unit(wi), unit(wo)))
    return found
