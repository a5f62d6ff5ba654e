"""Directions and parameters at which formulas break, for every model.

All numbers are exact in single precision, so that every evaluation, in whatever
precision, sees the same input.
"""

import numpy as np

from brdffit.models import MODELS
from brdffit.parameters import parameters, spectral_fields, values

AZIMUTH = 0.61  # rad, along no axis
NORMAL = (0.0, 0.0)  # polar angle and azimuth, rad
HALF_PI = np.pi / 2
WAVELENGTH = 0.55  # um

SKIPPED = ("sum",)  # of models that are in the catalogue themselves


def direction(theta, phi, height=None):
    """Unit vector in double precision; ``height`` is its z where given."""
    z = np.cos(theta) if height is None else height
    across = np.sqrt(1 - z * z)
    return np.array([across * np.cos(phi), across * np.sin(phi), z])


def directions():
    """Pairs ``(wi, wo)`` in float32 by what is hard about them, in groups."""
    n = np.array([0.0, 0.0, 1.0])

    def turned(phi, **where):
        return direction(where.get("theta", 0.0), AZIMUTH + phi, where.get("height"))

    slanted = {"theta": np.radians(50)}
    found = {
        "normal, normal": (n, n),
        "normal, 1e-4 rad off": (n, direction(1e-4, 2.0)),
        "normal, 50 deg": (n, turned(0, **slanted)),
        "50 deg, mirror": (turned(0, **slanted), turned(np.pi, **slanted)),
        "50 deg, 0.001 rad off mirror": (
            turned(0, **slanted),
            turned(np.pi, theta=slanted["theta"] + 1e-3),
        ),
        "50 deg, 3 deg off mirror": (
            turned(0, **slanted),
            turned(np.pi + 0.03, theta=slanted["theta"] + 0.05),
        ),
        "50 deg, retro": (turned(0, **slanted), turned(0, **slanted)),
        "50 deg, sideways": (turned(0, **slanted), turned(HALF_PI, theta=0.7)),
        "50 deg along x, mirror": (
            direction(slanted["theta"], 0),
            direction(slanted["theta"], 0) * [-1, 1, 1],
        ),
    }
    for text, height in (("1e-3 rad", 1e-3), ("1e-6 rad", 1e-6)):
        low = turned(0, height=height)
        found |= {
            f"{text}, mirror": (low, low * [-1, -1, 1]),
            f"{text}, nearly mirror": (low, turned(np.pi + 1e-4, height=2 * height)),
            f"{text}, retro": (low, low),
            f"{text}, sideways": (low, turned(HALF_PI, height=2 * height)),
            f"{text}, normal": (low, n),
            f"50 deg, {text}": (
                turned(0, **slanted),
                turned(np.pi + 0.3, height=height),
            ),
        }
    found |= {
        "1e-6 rad along x, retro": (direction(0, 0, 1e-6), direction(0, 0, 1e-6)),
        "horizon, 50 deg": (turned(0, height=0.0), turned(2, **slanted)),
        "horizon, mirror": (turned(0, height=0.0), turned(0, height=0.0) * [-1, -1, 1]),
        "50 deg, 1e-6 rad below": (turned(0, **slanted), turned(2, height=-1e-6)),
        "below, below": (turned(0, height=-0.5), turned(2, height=-0.5)),
    }
    return {
        label: tuple(w.astype(np.float32) for w in pair)
        for label, pair in found.items()
    }


def settings(name):
    """Parameters of a model by what is hard about them.

    Each nonlinear parameter goes to both ends of its legal and of its typical interval
    while the others are everyday; the linear ones go to their ends together; and all
    go to their lower and to their upper bounds.
    """
    model = MODELS[name]
    known = parameters(model)
    everyday = {p: float(np.max(x)) for p, x in values(model()).items()}
    fixed = {p: WAVELENGTH for p in spectral_fields(model) if p not in known}
    linear = [p for p in known if known[p].linear]
    found = {"everyday": everyday}
    for edge in ("lower", "upper") if linear else ():
        ends = {p: getattr(known[p], edge) for p in linear}
        text = " = ".join([*linear, f"{next(iter(ends.values())):g}"])
        found[text] = everyday | ends
    for p in known:
        if p not in linear:
            ends = {known[p].lower, *known[p].typical, known[p].upper}
            for value in sorted(ends - {everyday[p]}):
                found[f"{p} = {value:g}"] = everyday | {p: value}
    for edge in ("lower", "upper"):
        found[f"all at their {edge} bound"] = {
            p: getattr(known[p], edge) for p in known
        }
    return {
        label: {p: np.float32(x) for p, x in (chosen | fixed).items()}
        for label, chosen in found.items()
    }


def cases(name):
    """All settings with all directions: parameters ``(N,)`` by name, both ``(N, 3)``.

    Directions change fastest.
    """
    pairs, chosen = list(directions().values()), list(settings(name).values())
    count = len(pairs)
    wi, wo = (np.tile([pair[n] for pair in pairs], (len(chosen), 1)) for n in (0, 1))
    return {p: np.repeat([c[p] for c in chosen], count) for p in chosen[0]}, wi, wo
