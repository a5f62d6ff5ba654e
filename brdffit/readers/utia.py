"""UTIA binary: an anisotropic material on a regular grid of four angles.

Doubles without a header (Filip and Vavra, "Template-Based Sampling of Anisotropic
BRDFs", Pacific Graphics 2014): for each of three channels a square image, whose rows
are directions of the light and columns directions of the viewer. Either runs through
six polar angles from 0 to 75 degrees in steps of 15, and for each through 48 azimuths
in steps of 7.5 degrees.

The numbers are taken as they stand, as linear RGB in 1/sr up to a factor: the database
does not state their scale. Negative values occur; they are kept and masked.
"""

from pathlib import Path

import numpy as np

from brdffit.readers import validity
from brdffit.readers.angles import directions
from brdffit.samples import Measurement

DESCRIPTION = "UTIA binary: anisotropic material on a grid of angles"
SUFFIXES = (".bin",)
SIZE = 3 * (6 * 48) ** 2 * 8
BEGINS = f"with doubles and is {SIZE} bytes long"

LARGEST = 1e6  # of a number that can be a reflectance


def matches(path: Path, head: bytes) -> bool:
    """Whether a file has the size of the grid and holds doubles."""
    if path.is_dir() or path.stat().st_size != SIZE:
        return False
    start = np.frombuffer(head[: len(head) // 8 * 8], "<f8")
    return bool(np.isfinite(start).all() and (np.abs(start) < LARGEST).all())


def load(path: Path | str) -> Measurement:
    """Read all pairs of directions.

    Raises:
        ValueError: The file has another size than the grid, or no value can be used.
        OSError: The file cannot be read.
    """
    path = Path(path)
    validity.require_size(path, SIZE, "UTIA")
    theta, phi = np.meshgrid(np.arange(6) * 15.0, np.arange(48) * 7.5, indexing="ij")
    grid = directions(np.deg2rad(theta.ravel()), np.deg2rad(phi.ravel()))
    return validity.measurement(
        path,
        wi=np.repeat(grid, len(grid), axis=0),
        wo=np.tile(grid, (len(grid), 1)),
        f_r=np.fromfile(path, "<f8").reshape(3, -1).T,
        channels=("R", "G", "B"),
        name=path.stem,
    )
