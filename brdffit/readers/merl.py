"""MERL binary: an isotropic material on a grid of half and difference angles.

Three 32-bit integers, 90, 90 and 180, are followed by 90 x 90 x 180 doubles for red,
then for green, then for blue, all little-endian. A number times the scale of its
channel is f_r. Numbers below zero, mostly -1, mark cells without data. Directions are
those of the centre of each cell (see `brdffit.half_difference`), ``solid_angle`` is the
size of each cell in sr^2.
"""

from pathlib import Path

import numpy as np

from brdffit import half_difference
from brdffit.readers import validity
from brdffit.samples import Measurement
from brdffit.types import Values, Vectors

DESCRIPTION = "MERL binary: isotropic material on half and difference angles"
SUFFIXES = (".binary",)
BEGINS = "with the integers 90, 90 and 180, of four bytes each"

RECIPROCAL = True  # exchanged directions share a cell

SCALES = (1.0 / 1500, 1.15 / 1500, 1.66 / 1500)
HEADER = np.array(half_difference.SHAPE, "<i4").tobytes()
SIZE = len(HEADER) + 3 * half_difference.COUNT * 8


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a file begins with the dimensions of MERL's grid."""
    return head.startswith(HEADER)


def load(path: Path | str) -> Measurement:
    """Read all cells of a material; those without data or below the horizon are masked.

    Raises:
        ValueError: The file has another size than its header says, or no data.
        OSError: The file cannot be read.
    """
    path = Path(path)
    validity.require_size(path, SIZE, "MERL")
    stored = np.fromfile(path, "<f8", offset=len(HEADER)).reshape(3, -1)
    stored *= np.array(SCALES)[:, None]
    wi, wo, solid_angle = half_difference.cells()
    return validity.measurement(
        path,
        wi,
        wo,
        stored.T,
        solid_angle=solid_angle,
        channels=("R", "G", "B"),
        name=path.stem,
    )


def evaluate(path: Path | str, wi: Vectors, wo: Vectors) -> Values:
    """Reflectance ``f_r (N, 3)`` of the cells that directions fall into.

    0 where a direction lies at or below the horizon; NaN where there is no data, as in
    cells whose centre lies below it.

    Raises:
        ValueError: The file has another size than its header says, or no data.
        OSError: The file cannot be read.
    """
    data = load(path)
    f_r = np.where(np.asarray(data.mask), data.f_r, np.nan)
    seen = (wi[:, 2] > 0) & (wo[:, 2] > 0)
    cells = half_difference.cell_of(wi, wo)
    return np.where(seen[:, None], f_r[cells], 0.0)
