r"""FRED text: blocks of scatter angles and values, one for each angle of incidence.

A file of Photon Engineering's FRED reads::

    type bsdf_data
    format angles=deg bsdf=value scale=1
    30  0
    0   0   0.020408
    5   0   0.021313
    5   10  0.021195

A line of two numbers gives polar angle and azimuth of the incident light and begins a
block; the lines of three below it give those of the scattered light, and the value,
which is multiplied by ``scale``. The mirror direction lies at equal polar angles and
equal azimuths: azimuth is that of the light as it *travels*, so 0 is forward.
"""

from array import array
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from brdffit.readers import text, validity
from brdffit.readers.angles import directions
from brdffit.samples import Measurement

DESCRIPTION = "FRED text: tabulated scatter"
SUFFIXES = (".txt",)
BEGINS = "with the line `type bsdf_data`"

UNITS = {"deg": np.pi / 180, "rad": 1.0}


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a file begins as FRED's does."""
    return head.removeprefix(b"\xef\xbb\xbf").split()[:2] == [b"type", b"bsdf_data"]


def load(path: Path | str) -> Measurement:
    """Read all rows of a file of FRED.

    Raises:
        ValueError: The header or a line is wrong, or the file is cut off.
        OSError: The file cannot be read.
    """
    path = Path(path)
    rows = text.lines(path)
    unit, scale = read_header(path, rows)
    lights, starts, scattered = read_blocks(path, rows)
    refuse_cut(path, starts, scattered)
    counts = np.diff([*starts, len(scattered)])
    theta_i, phi_i = np.repeat(lights * unit, counts, axis=0).T
    theta_o, phi_o = scattered[:, :2].T * unit
    with np.errstate(over="ignore"):  # infinity is masked
        f_r = scattered[:, 2:] * scale
    return validity.measurement(
        path,
        wi=directions(theta_i, phi_i),
        wo=directions(theta_o, phi_o + np.pi),
        f_r=f_r,
        channels=("f_r",),
        name=path.stem,
    )


def read_header(path: Path, rows: Iterator[text.Line]) -> tuple[float, float]:
    """Radians in the file's unit of angle, and what values are multiplied by."""
    next(rows, None)  # `type bsdf_data`
    row = next(rows, None)
    if row is None:
        raise ValueError(
            f"FRED file `{path}` ends after its first line; it is cut off."
        )
    parts = (word.partition("=") for word in row.text.split()[1:])
    options = {key: value for key, _, value in parts}
    if not row.text.startswith("format") or options.get("angles") not in UNITS:
        raise row.error("it must say `format angles=deg` or `format angles=rad`.")
    if options.get("bsdf") != "value":
        raise row.error("only `bsdf=value` can be read; export the file in that form.")
    return UNITS[options["angles"]], row.number_from(options.get("scale", "1"))


def read_blocks(
    path: Path, rows: Iterator[text.Line]
) -> tuple[np.ndarray, list[int], np.ndarray]:
    """Angles of incidence ``(blocks, 2)``, first row of each block, rows ``(N, 3)``."""
    lights, scattered, starts = array("d"), array("d"), []
    for row in rows:
        numbers = row.numbers()
        if len(numbers) == 2 and len(scattered) // 3 not in starts[-1:]:
            starts.append(len(scattered) // 3)
            lights.extend(numbers)
        elif len(numbers) == 3 and starts:
            scattered.extend(numbers)
        else:
            raise row.error(
                "a block must begin with two numbers, the angle of incidence, and go "
                "on with lines of three; the line may be cut off."
            )
    if not scattered or starts[-1] == len(scattered) // 3:
        raise ValueError(
            f"FRED file `{path}` ends before the rows of a block; it is cut off."
        )
    return (
        np.frombuffer(lights).reshape(-1, 2),
        starts,
        np.frombuffer(scattered).reshape(-1, 3),
    )


def refuse_cut(path: Path, starts: list[int], scattered: np.ndarray) -> None:
    """Refuse a last block that stops short of the polar angle where all others end."""
    *others, last = scattered[[*(start - 1 for start in starts[1:]), -1], 0]
    if len(set(others)) == 1 and last < others[0]:
        raise ValueError(
            f"FRED file `{path}` is cut off: its last block ends at polar angle "
            f"{last:g}, all others at {others[0]:g}."
        )
