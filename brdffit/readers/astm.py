"""ASTM E1392-96: a header of keywords, then one line for each pair of directions.

The line ``VARS`` ends the header and names the columns, for instance
``theta_i,phi_i,theta_s,phi_s,R,G,B``, or wavelengths such as ``400nm`` instead of
colours; ``s`` is the scattered direction. Both directions leave the surface, so the
mirror direction of azimuth 0 is at pi. ``NUM_POINTS`` says how many lines follow.

Cornell's files give angles in radians. A polar angle beyond pi/2 cannot be one of
radians above the surface, so a file that has one is taken to be in degrees.
"""

from pathlib import Path

import numpy as np

from brdffit.readers import text, validity
from brdffit.readers.angles import directions
from brdffit.samples import Measurement

DESCRIPTION = "ASTM E1392-96 text: keywords, then one line for each pair of directions"
SUFFIXES = (".astm",)
BEGINS = "with a header of keywords that ends with a line `VARS theta_i,phi_i,...`"

ANGLES = ("theta_i", "phi_i", "theta_s", "phi_s")


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a line names variables, angles among them."""
    lines = (line.split(None, 1) for line in head.splitlines())
    return any(
        len(words) == 2 and words[0] == b"VARS" and b"theta_" in words[1]
        for words in lines
    )


def load(path: Path | str) -> Measurement:
    """Read all pairs of directions.

    Raises:
        ValueError: The header or a line is wrong, or the file is cut off.
        OSError: The file cannot be read.
    """
    path = Path(path)
    rows = text.lines(path)
    points = None
    for row in rows:
        keyword, _, value = row.text.partition(" ")
        if keyword == "NUM_POINTS":
            points = row.number_from(value)
        if keyword == "VARS":
            break
    else:
        raise ValueError(f"ASTM file `{path}` has no line `VARS`; it is cut off.")
    names = [name.strip() for name in value.split(",")]
    if len(set(names)) < len(names) or not set(ANGLES) < set(names):
        raise row.error(f"it must name {', '.join(ANGLES)} and at least one channel.")
    table = text.table(path, rows, len(names))
    if points not in (None, len(table)):
        raise ValueError(
            f"ASTM file `{path}` promises {points:g} points, but has {len(table)}; it "
            f"is cut off."
        )
    columns = dict(zip(names, table.T, strict=True))
    theta_i, phi_i, theta_o, phi_o = (columns.pop(name) for name in ANGLES)
    steepest = max(np.abs(theta_i).max(), np.abs(theta_o).max())
    unit = 1.0 if steepest < np.pi / 2 + 0.01 else np.pi / 180
    return validity.measurement(
        path,
        wi=directions(theta_i * unit, phi_i * unit),
        wo=directions(theta_o * unit, phi_o * unit),
        f_r=np.stack(list(columns.values()), axis=1),
        channels=tuple(columns),
        name=path.stem,
    )
