"""Reciprocity of data: does f_r stay when light and viewer change places?

A measurement seldom holds both of a pair, so each sample is compared with the nearest
one to its exchanged directions. Samples of an isotropic surface are compared by polar
angles and the difference of azimuths, which leaves many more to compare. Where a format
can be evaluated at any directions, the exchange is exact.
"""

import dataclasses
from collections.abc import Callable

import numpy as np
from jaxtyping import Float
from scipy.spatial import KDTree

from brdffit.samples import Measurement, Samples, as_samples
from brdffit.types import Values, Vectors

NEAR = 1.0  # degrees within which directions count as exchanged
FEWEST = 10  # pairs that say something
MOST = 20_000  # samples that are looked at
SAME = 0.5  # degrees within which directions are equal before the exchange

Evaluate = Callable[[Vectors, Vectors], Values]


@dataclasses.dataclass(frozen=True)
class Reciprocity:
    """Relative differences ``|a - b| / max(a, b)`` of f_r between exchanged directions.

    Attributes:
        pairs: Number of values compared.
        median: Half of the differences are smaller.
        ninetieth: Nine tenths of them are smaller.
        isotropic: True when pairs were found by the difference of azimuths.
        exact: True when the data could be evaluated at the exchanged directions.
    """

    pairs: int
    median: float
    ninetieth: float
    isotropic: bool
    exact: bool


def reciprocity(
    data: Measurement | Samples, evaluate: Evaluate | None = None
) -> Reciprocity | None:
    """Differences between samples whose directions are exchanged, within a degree.

    Of large data a random share is looked at.

    Args:
        data: What was measured.
        evaluate: ``f_r`` of the same data at any directions, if that is known.

    Returns:
        None when there are several lights, or too few pairs in the data.
    """
    samples = as_samples(data)
    if samples.value is None or samples.wi.shape[1] != 1:
        return None
    use = np.isfinite(np.asarray(samples.value))
    if samples.mask is not None:
        use &= np.asarray(samples.mask)
    rows = np.flatnonzero(use.any(axis=1))
    if len(rows) > 20 * MOST:
        rows = np.random.default_rng(0).choice(rows, 20 * MOST, replace=False)
    samples, use = samples.take(rows), use[rows]
    f_r = np.where(use, samples.f_r, np.nan)
    wi = np.asarray(samples.wi[:, 0], float)
    wo = np.asarray(samples.wo, float)
    if evaluate is not None:
        lowest = wi[:, 2].min()  # beyond which nothing was measured
        rows = np.flatnonzero(wo[:, 2] >= lowest)[:MOST]
        found = relative(f_r[rows], evaluate(wo[rows], wi[rows]))
        return _of(found, isotropic=False, exact=True)
    kinds = (True,) if samples.pixels is not None else (False, True)
    for isotropic in kinds:
        found = differences(wi, wo, f_r, isotropic)
        if result := _of(found, isotropic, exact=False):
            return result
    return None


def _of(found: np.ndarray, isotropic: bool, exact: bool) -> Reciprocity | None:
    if len(found) < FEWEST:
        return None
    middle, high = np.percentile(found, [50, 90])
    return Reciprocity(len(found), float(middle), float(high), isotropic, exact)


def differences(
    wi: Float[np.ndarray, "sample 3"],
    wo: Float[np.ndarray, "sample 3"],
    f_r: Float[np.ndarray, "sample channel"],
    isotropic: bool,
) -> Float[np.ndarray, " pair"]:
    """Relative difference of each value to that of the nearest exchanged sample.

    Samples that are their own partner, such as retroreflection, say nothing and are
    left out.
    """
    if isotropic:
        here, there = turned(wi, wo), turned(wo, wi)
    else:
        here, there = np.hstack([wi, wo]), np.hstack([wo, wi])
    telling = np.linalg.norm(here - there, axis=1) > np.radians(SAME)
    places = np.flatnonzero(telling)
    if len(places) > MOST:
        places = np.random.default_rng(0).choice(places, MOST, replace=False)
    if not len(places):
        return np.empty(0)
    distance, partner = KDTree(here).query(
        there[places], distance_upper_bound=np.radians(NEAR)
    )
    found = np.isfinite(distance)
    return relative(f_r[places[found]], f_r[np.asarray(partner)[found]])


def relative(a: Values, b: Values) -> Float[np.ndarray, " pair"]:
    """``|a - b| / max(a, b)`` where both are known, not negative and not both 0."""
    larger = np.maximum(a, b)
    both = (a >= 0) & (b >= 0) & (larger > 0) & (larger < np.inf)
    return np.abs(a[both] - b[both]) / larger[both]


def turned(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """Both directions turned, and mirrored, so that the first has azimuth 0.

    The second then lies on one side: a surface without grain looks the same.
    """
    radius = np.hypot(wi[:, 0], wi[:, 1])
    safe = np.where(radius > 0, radius, 1)
    along = (wi[:, 0] * wo[:, 0] + wi[:, 1] * wo[:, 1]) / safe
    across = np.abs(wi[:, 0] * wo[:, 1] - wi[:, 1] * wo[:, 0]) / safe
    along = np.where(radius > 0, along, np.hypot(wo[:, 0], wo[:, 1]))
    return np.stack([radius, wi[:, 2], along, across, wo[:, 2]], axis=1)
