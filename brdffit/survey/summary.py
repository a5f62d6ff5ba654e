"""A measurement in numbers: what it covers, which values it has, which are invalid."""

import dataclasses
import math
from typing import Any

import numpy as np

from brdffit.readers.validity import HORIZON
from brdffit.samples import Measurement, Samples, as_samples
from brdffit.survey.reciprocity import Evaluate, Reciprocity, reciprocity


@dataclasses.dataclass(frozen=True)
class Summary:
    """What a measurement holds.

    Attributes:
        name: What was measured.
        samples: Number of pairs of directions, or of pixels.
        lights: Number of lights that shine on each sample together.
        images: Number of images; 0 for a goniometer.
        channels: Names of the channels.
        quantity: What the values are, with their unit.
        lowest: Smallest usable value of each channel.
        highest: Largest usable value of each channel.
        usable: Number of values that may be used, all channels together.
        invalid: Numbers of the others by the reason, those above 0.
        theta_i: Smallest and largest polar angle of the light in degrees.
        theta_o: Smallest and largest polar angle of the viewer in degrees.
        azimuths: Number of distinct azimuths of the light, by whole degrees.
        sigma: Whether the error of every value is known.
        solid_angle: Whether the share of directions that a sample stands for is known.
        reciprocity: Error of the data themselves, or None when it cannot be told.
    """

    name: str
    samples: int
    lights: int
    images: int
    channels: tuple[str, ...]
    quantity: str
    lowest: tuple[float, ...]
    highest: tuple[float, ...]
    usable: int
    invalid: dict[str, int]
    theta_i: tuple[float, float]
    theta_o: tuple[float, float]
    azimuths: int
    sigma: bool
    solid_angle: bool
    reciprocity: Reciprocity | None

    def to_dict(self) -> dict[str, Any]:
        """The summary in types that JSON knows; None where there is no number."""
        return {
            name: [None if item != item else item for item in value]
            if isinstance(value, tuple)
            else value
            for name, value in dataclasses.asdict(self).items()
        }


def summary(
    data: Measurement | Samples,
    evaluate: Evaluate | None = None,
    folded: bool = False,
) -> Summary:
    """Count and measure what data hold.

    Args:
        data: What was read.
        evaluate: As for `reciprocity`.
        folded: Whether both orders of a pair are one value in the format, so that
            nothing can be said of reciprocity.

    Raises:
        ValueError: They have no values, as those of a scene that was not rendered.
    """
    samples = as_samples(data)
    if samples.value is None:
        raise ValueError(f"Samples `{samples.name}` must have values to be summarised.")
    value = np.asarray(samples.value)
    use = np.isfinite(value)
    if samples.mask is not None:
        use &= np.asarray(samples.mask)
    shown = np.where(use, value, np.nan)
    filled = [channel[np.isfinite(channel)] for channel in shown.T]
    above = np.asarray(samples.wi[..., 2] > HORIZON).any(axis=1)
    above &= np.asarray(samples.wo[:, 2] > HORIZON)
    seen = np.asarray(samples.wi)[above]
    azimuth = np.degrees(np.arctan2(seen[..., 1], seen[..., 0]))
    slanted = np.hypot(seen[..., 0], seen[..., 1]) > HORIZON
    return Summary(
        name=samples.name,
        samples=len(samples),
        lights=samples.wi.shape[1],
        images=samples.pixels.shape[0] if samples.pixels else 0,
        channels=samples.channels,
        quantity="f_r [1/sr]" if isinstance(data, Measurement) else "pixel value",
        lowest=tuple(float(c.min()) + 0.0 if len(c) else math.nan for c in filled),
        highest=tuple(float(c.max()) + 0.0 if len(c) else math.nan for c in filled),
        usable=int(use.sum()),
        invalid=reasons(value, use, above),
        theta_i=span(seen[..., 2]),
        theta_o=span(np.asarray(samples.wo)[above, 2]),
        azimuths=max(len(np.unique(np.round(azimuth[slanted]) % 360)), 1),
        sigma=samples.sigma is not None,
        solid_angle=samples.solid_angle is not None,
        reciprocity=None if folded else reciprocity(data, evaluate),
    )


def reasons(value: np.ndarray, use: np.ndarray, above: np.ndarray) -> dict[str, int]:
    """How many values are not used, by the first reason that holds for each."""
    left, counts = ~use, {}
    for reason, holds in {
        "below the horizon": np.broadcast_to(~above[:, None], use.shape),
        "not finite": ~np.isfinite(value),
        "negative": np.nan_to_num(value) < 0,
        "masked by the file, saturated or unlit": np.ones_like(use),
    }.items():
        counts[reason] = int(np.sum(left & holds))
        left = left & ~holds
    return {reason: count for reason, count in counts.items() if count}


def span(cosines: np.ndarray) -> tuple[float, float]:
    """Smallest and largest polar angle in degrees above the horizon."""
    cosines = cosines[cosines > HORIZON]
    if not len(cosines):
        return math.nan, math.nan
    theta = np.degrees(np.arccos(np.clip([cosines.max(), cosines.min()], -1, 1)))
    return float(theta[0]), float(theta[1])
