"""In which order samples and their lights are laid out.

The first samples stand for all, so that a search can begin on them. The others are
sorted by the number of lights that reach them, and the lights of each sample begin with
those that do: dark ones at the end are never evaluated.
"""

import numpy as np
from jaxtyping import Bool, Float, Int

from brdffit.types import Values

HARMLESS = (0.6, 0.0, 0.8)  # direction of places that hold no sample, or no light


def in_order(
    value: Values, lit: Int[np.ndarray, " sample"], ahead: int
) -> Int[np.ndarray, " sample"]:
    """Indices of samples in an order in which the first ``ahead`` stand for all.

    Of these three quarters are every so-manieth sample, one of the brightest.

    Args:
        value: Observations.
        lit: Number of lights that reach each sample.
        ahead: How many samples come first.
    """
    rows = np.arange(len(value))
    if len(rows) <= ahead:
        return rows
    bright = np.argsort(np.nansum(value, axis=1))[-max(len(rows) // 20, 1) :]
    bright = bright[:: max(1, len(bright) // (ahead // 4))][: ahead // 4]
    rest = np.setdiff1d(rows, bright, assume_unique=True)
    even = rest[np.linspace(0, len(rest) - 1, ahead - len(bright)).astype(int)]
    first = np.concatenate([bright, even])
    others = np.setdiff1d(rows, first, assume_unique=True)
    return np.concatenate([first, others[np.argsort(lit[others], kind="stable")]])


def lit_first(
    lit: Bool[np.ndarray, "sample light"],
    wi: Float[np.ndarray, "sample light 3"],
    weight: Float[np.ndarray, "sample light channel"],
) -> tuple[np.ndarray, np.ndarray]:
    """Directions and weights with the lights that reach a sample before the others.

    As many lights are left as reach any sample, one at least; those that do not reach
    a sample get weight 0 and a direction above the horizon.

    Args:
        lit: Whether a light reaches a sample.
        wi: Directions to the lights.
        weight: Weights of the lights.
    """
    wi = np.where(lit[..., None], wi, HARMLESS)
    weight = np.where(lit[..., None], weight, 0)
    if lit.shape[1] == 1 or lit.all():
        return wi, weight
    left = max(int(lit.sum(axis=1).max()), 1)
    order = np.argsort(~lit, axis=1, kind="stable")[:, :left, None]
    return np.take_along_axis(wi, order, 1), np.take_along_axis(weight, order, 1)
