"""Write a measurement on MERL's grid as MERL binary (see `brdffit.readers.merl`)."""

from pathlib import Path

import numpy as np

from brdffit import half_difference
from brdffit.files import replacing
from brdffit.samples import Measurement

SCALES = (1.0 / 1500, 1.15 / 1500, 1.66 / 1500)
NO_DATA = -1.0


def save(measurement: Measurement, path: Path | str) -> None:
    """Write three channels given at the cells of `brdffit.half_difference.cells`.

    What the mask excludes is written as -1, MERL's sign for no data.
    The stored double is f_r over the scale of its channel, moved by a last bit where
    that makes reading give f_r back exactly.

    Raises:
        ValueError: The directions are not those of the grid, or not three channels.
        OSError: The file cannot be written.
    """
    if measurement.f_r.shape != (half_difference.COUNT, 3) or not on_grid(measurement):
        raise ValueError(
            f"`{measurement.name}` cannot be written as MERL file `{path}`: it must "
            f"have three channels at the {half_difference.COUNT} pairs of directions "
            f"of brdffit.half_difference.cells."
        )
    mask = measurement.mask
    with replacing(path) as temporary, temporary.open("wb") as stream:
        stream.write(np.array(half_difference.SHAPE, "<i4").tobytes())
        for channel, scale in enumerate(SCALES):
            f_r = np.asarray(measurement.f_r[:, channel], np.float64)
            stored = unscaled(f_r, scale)
            if mask is not None:
                stored[~np.asarray(mask[:, channel])] = NO_DATA
            stored.astype("<f8").tofile(stream)


def on_grid(measurement: Measurement) -> bool:
    """Whether the directions are those of the cells, within single precision."""
    wi, wo, _ = half_difference.cells()
    return measurement.wi.shape == wi.shape and bool(
        np.allclose(measurement.wi, wi, rtol=0, atol=1e-6)
        and np.allclose(measurement.wo, wo, rtol=0, atol=1e-6)
    )


def unscaled(f_r: np.ndarray, scale: float) -> np.ndarray:
    """``f_r / scale``, rounded so that times ``scale`` gives ``f_r`` where it can."""
    stored = f_r / scale
    for towards in (-np.inf, np.inf):
        neighbour = np.nextafter(stored, towards)
        better = (stored * scale != f_r) & (neighbour * scale == f_r)
        stored[better] = neighbour[better]
    return stored
