"""A random share of many samples that stands for all of them."""

import dataclasses

import numpy as np

from brdffit.samples import Measurement, Samples


def subset(
    data: Measurement | Samples, count: int, seed: int = 0
) -> Measurement | Samples:
    """At most so many of the samples, weighted so that their sums are those of all.

    A sample is drawn with a chance made half of an equal share and half of its share of
    the solid angle, so that neither a highlight of small cells nor a large cell is
    missed, and its solid angle is divided by that chance. Masked samples are left out.
    The name says how many of how many there are.

    Args:
        data: What was measured.
        count: How many samples to keep; all when there are not more.
        seed: Seed of the draw.

    Raises:
        ValueError: The number is below 1.
    """
    if count < 1:
        raise ValueError(f"The number of samples must be 1 or above, but is {count}.")
    mask = None if data.mask is None else np.asarray(data.mask).any(axis=1)
    rows = np.arange(len(data)) if mask is None else np.flatnonzero(mask)
    if len(rows) <= count:
        return data
    size = np.ones(len(rows))
    if data.solid_angle is not None:
        size = np.asarray(data.solid_angle, float)[rows]
    chance = chances(0.5 / len(rows) + 0.5 * size / size.sum(), count)
    drawn = systematic(chance, np.random.default_rng(seed).uniform())
    chosen = taken(data, rows[drawn])
    return dataclasses.replace(
        chosen,
        solid_angle=size[drawn] / chance[drawn],
        name=f"{data.name} ({len(drawn)} of {len(rows)} samples)",
    )


def chances(share: np.ndarray, count: int) -> np.ndarray:
    """Chance of each sample, by its share and at most 1; they sum to the count."""
    chance = np.minimum(count * share, 1)
    for _ in range(20):  # what is cut off at 1 goes to the others
        free = chance < 1
        left = count - np.count_nonzero(~free)
        chance[free] = np.minimum(share[free] * (left / share[free].sum()), 1)
    return chance


def systematic(chance: np.ndarray, start: float) -> np.ndarray:
    """Places drawn at equal steps along the sum of the chances, none of them twice."""
    steps = np.floor(np.cumsum(chance) + start)
    return np.flatnonzero(np.diff(steps, prepend=np.floor(start)) > 0)


def taken(data: Measurement | Samples, rows: np.ndarray) -> Measurement | Samples:
    """Some samples of a measurement or of an image."""
    if isinstance(data, Samples):
        return data.take(rows)
    arrays = ("wi", "wo", "f_r", "sigma", "mask")
    picked = {
        name: None
        if getattr(data, name) is None
        else np.asarray(getattr(data, name))[rows]
        for name in arrays
    }
    return dataclasses.replace(data, **picked, solid_angle=None)
