"""Spectral data in RGB, as they look under a stated light.

Reflectance at wavelengths is weighted with the light and with the eye, and taken to
linear Rec. 709 with the white of the light as white (see `brdffit.optics`); between the
wavelengths it is interpolated linearly, beyond them it stays as it is at the ends.
"""

import dataclasses
import re
from collections.abc import Sequence

import numpy as np

from brdffit.samples import Measurement, Samples

UNITS = {"nm": 1.0, "um": 1000.0}
COVERED = (430.0, 670.0)  # nm that wavelengths must reach, beyond which little is seen
WIDEST = 60.0  # nm between neighbours


def wavelengths(channels: Sequence[str]) -> np.ndarray | None:
    """Wavelengths in nm that names of channels tell, as in ``532 nm``, or None."""
    found = []
    for name in channels:
        match = re.fullmatch(r"([\d.]+)\s*(nm|um)", name.strip())
        if match is None:
            return None
        found.append(float(match[1]) * UNITS[match[2]])
    return np.array(found)


def rgb_matrix(at: np.ndarray, illuminant: str = "D65") -> np.ndarray:
    """Share ``(C, 3)`` of each wavelength in red, green and blue.

    Args:
        at: Wavelengths in nm, increasing.
        illuminant: Name of a light in colour-science, such as D65, A or E.

    Raises:
        ValueError: No such light, or too few wavelengths to see colours by.
    """
    gaps = np.diff(at)
    covers = len(at) > 1 and at[0] <= COVERED[0] and at[-1] >= COVERED[1]
    if not covers or not np.all(gaps > 0) or gaps.max() > WIDEST:
        raise ValueError(
            f"Wavelengths must increase from {COVERED[0]:g} nm or less to "
            f"{COVERED[1]:g} nm or more in steps of at most {WIDEST:g} nm to become "
            f"RGB, but are {', '.join(f'{x:g}' for x in at[:6])}"
            f"{' and so on' if len(at) > 6 else ''}."
        )
    from brdffit.optics import rgb_weights  # slow to import: it brings scipy

    grid, weights = rgb_weights(illuminant)
    to_grid = np.stack(
        [np.interp(1000 * grid, at, row) for row in np.eye(len(at))], axis=1
    )
    return to_grid.T @ weights


def to_rgb(
    data: Measurement | Samples, illuminant: str = "D65"
) -> Measurement | Samples:
    """The same data with the channels R, G, B.

    A value is used where all wavelengths are. Colours beyond Rec. 709 have a negative
    channel, which is masked in a measurement.

    Args:
        data: Measurement, or pixels lit by white light, with a wavelength in the name
            of every channel.
        illuminant: As for `rgb_matrix`.

    Raises:
        ValueError: The channels are no wavelengths, or too few; or the lights are
            coloured.
    """
    known = wavelengths(data.channels)
    if known is None:
        names = ", ".join(data.channels[:4]) or "no names"
        more = " and so on" if len(data.channels) > 4 else ""
        raise ValueError(
            f"Data `{data.name}` must have wavelengths for channels, as in `532 nm`, "
            f"to be seen under an illuminant, but have {names}{more}."
        )
    order = np.argsort(known)
    matrix = rgb_matrix(known[order], illuminant)[np.argsort(order)]
    field = "f_r" if isinstance(data, Measurement) else "value"
    value = np.asarray(getattr(data, field), np.float64)
    use = np.isfinite(value)
    if data.mask is not None:
        use &= np.asarray(data.mask)
    seen = np.where(use, value, 0) @ matrix
    whole = np.repeat(use.all(axis=1, keepdims=True), 3, axis=1)
    sigma = data.sigma
    if sigma is not None:
        sigma = np.sqrt(np.asarray(sigma, np.float64) ** 2 @ matrix**2)
    new = {
        field: np.where(whole, seen, np.nan),
        "mask": whole & (seen >= 0) if field == "f_r" else whole,
        "sigma": sigma,
        "channels": ("R", "G", "B"),
        "name": f"{data.name} under {illuminant}",
    }
    if not isinstance(data, Measurement):
        weight = np.asarray(data.weight)
        if not np.allclose(weight, weight[..., :1], rtol=1e-5):
            raise ValueError(
                f"Pixels of `{data.name}` must be lit by white light to be seen under "
                f"an illuminant, but their lights are coloured."
            )
        new["weight"] = np.repeat(weight[..., :1], 3, axis=-1)
    return dataclasses.replace(data, **new)
