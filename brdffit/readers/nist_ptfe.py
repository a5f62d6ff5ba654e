"""CSV of NIST's sintered PTFE: reflectance and Mueller matrix, geometry by geometry.

The columns are described by T. A. Germer, "Full four-dimensional and reciprocal Mueller
matrix bidirectional reflectance distribution function of sintered
polytetrafluoroethylene", Applied Optics 56, 2017: wavelength in micrometres, incident
and reflected polar angle and azimuth in degrees, unpolarised reflectance in 1/sr, then
fifteen elements of the Mueller matrix, which are not read.

The incident polar angle is signed: it is negative, with azimuth 0, so that the light
comes from azimuth 180 degrees, and reflected azimuth 0 is forward.
"""

from pathlib import Path

import numpy as np

from brdffit.readers import text, validity
from brdffit.readers.angles import directions
from brdffit.samples import Measurement

DESCRIPTION = "NIST CSV of sintered PTFE: unpolarised reflectance"
SUFFIXES = (".csv",)
BEGINS = "with the column names `lambda,thetai`"

COLUMNS = 21
USED = 6  # wavelength, two directions of two angles, reflectance


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether the columns are those of NIST's files."""
    return head.startswith(b"lambda,thetai,")


def load(path: Path | str) -> Measurement:
    """Read the unpolarised reflectance of all geometries.

    Raises:
        ValueError: A line is wrong, or there is more than one wavelength.
        OSError: The file cannot be read.
    """
    path = Path(path)
    rows = text.lines(path)
    next(rows, None)  # column names
    table = text.table(path, rows, COLUMNS)[:, :USED]
    wavelengths, theta_i, phi_i, theta_o, phi_o, f_r = table.T
    if (wavelengths != wavelengths[0]).any():
        raise ValueError(
            f"NIST file `{path}` holds several wavelengths; split it into one file for "
            f"each."
        )
    return validity.measurement(
        path,
        wi=directions(np.deg2rad(theta_i), np.deg2rad(phi_i)),
        wo=directions(np.deg2rad(theta_o), np.deg2rad(phi_o)),
        f_r=f_r[:, None],
        channels=(f"{1000 * wavelengths[0]:g} nm",),
        name=path.stem,
    )
