r"""brdffit table: comma-separated reflectance whose header says what the numbers are.

A goniometer's result in the format of brdffit looks like this::

    # brdffit table 1
    # name: black anodised aluminium
    # angles: degrees
    # cosine: not included
    theta_i,phi_i,theta_o,phi_o,f_r
    30,0,0,0,0.0306
    30,0,30,180,0.0351

The first line names the format and its version. Every other line that begins with
``#`` and stands before the column names is either one of the following or a comment.

===========  ============================================  =============================
line         values                                        when it may be left out
===========  ============================================  =============================
cosine       ``not included`` or ``included``              never: nothing can tell later
angles       ``degrees`` or ``radians``                    when the columns are vectors
channels     names of the channels, with commas between    then every column that is
                                                           not listed below is a channel
name         what was measured                             then it is the file's name
precision    ``float64`` or ``float32``                    then it is ``float64``
rows         the number of rows                            then a cut may be missed
===========  ============================================  =============================

Then comes one line with the names of the columns, in any order:

- directions, either as angles ``theta_i, phi_i, theta_o, phi_o`` or as unit vectors
  ``wi_x, wi_y, wi_z, wo_x, wo_y, wo_z``. Both leave the surface: ``i`` to the light,
  ``o`` to the viewer; ``theta`` is measured from the normal, ``phi`` from the tangent,
  counter-clockwise seen from above. So the mirror direction of ``phi_i = 0`` is
  ``phi_o = 180`` degrees;
- one column for each channel: f_r in 1/sr, or f_r times the cosine of ``theta_i`` when
  the header says ``cosine: included``. ``nan`` where nothing was measured;
- if known, the standard deviation of each, called ``sigma_`` and the channel;
- if some values must not be used, ``mask_`` and the channel: 1 to use, 0 not to;
- if samples stand for unequal shares of the domain, ``solid_angle`` in sr.

Then one line for each pair of directions. Numbers use a point and no thousands mark.
What `brdffit.writers.table.save` writes is read back to the last bit.
"""

import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from brdffit.readers import text, validity
from brdffit.readers.angles import directions
from brdffit.samples import Measurement

DESCRIPTION = "brdffit table: comma-separated, with a header that says what it holds"
SUFFIXES = (".csv",)
BEGINS = "with the line `# brdffit table 1`"

FIRST_LINE = "# brdffit table"
ANGLES = ("theta_i", "phi_i", "theta_o", "phi_o")
VECTORS = ("wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z")
PREFIXES = ("sigma_", "mask_")
CHOICES = {
    "cosine": ("not included", "included"),
    "angles": ("degrees", "radians"),
    "precision": ("float64", "float32"),
}


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a file begins as a table of brdffit does."""
    return head.removeprefix(b"\xef\xbb\xbf").startswith(FIRST_LINE.encode())


def load(path: Path | str) -> Measurement:
    """Read a table; the page above says how it is written.

    Raises:
        ValueError: The header or a line is wrong; the sentence names it.
        OSError: The file cannot be read.
    """
    path = Path(path)
    rows = text.lines(path)
    header, names = read_header(path, rows)
    if len(set(words(names.text))) < len(words(names.text)):
        raise names.error("a name stands twice.")
    table = read_body(path, rows, header, names)
    columns = dict(zip(words(names.text), table.T, strict=True))
    wi, wo = read_directions(columns, header, names)
    channels = read_channels(columns, header, names)

    def block(prefix: str) -> np.ndarray | None:
        found = [
            prefix + channel for channel in channels if prefix + channel in columns
        ]
        if found and len(found) < len(channels):
            raise names.error(f"`{prefix}` must stand before every channel or none.")
        return np.stack([columns[name] for name in found], axis=1) if found else None

    scale = 1.0
    if header["cosine"] == "included":
        scale = 1 / np.maximum(wi[:, 2:], validity.HORIZON)
    f_r, sigma, mask = block(""), block("sigma_"), block("mask_")
    assert f_r is not None
    with np.errstate(over="ignore"):  # infinity is masked
        f_r, sigma = f_r * scale, None if sigma is None else sigma * scale
    return validity.measurement(
        path,
        wi,
        wo,
        f_r,
        known=None if mask is None else mask > 0,
        sigma=sigma,
        solid_angle=columns.get("solid_angle"),
        channels=channels,
        name=header.get("name", path.stem),
    )


def words(line: str) -> list[str]:
    """The parts between the commas of a line."""
    return [word.strip() for word in line.split(",")]


def read_header(
    path: Path, rows: Iterator[text.Line]
) -> tuple[dict[str, str], text.Line]:
    """What the lines with ``#`` say, and the line with the names of the columns."""
    header = {"precision": "float64"}
    for row in rows:
        if not row.text.startswith("#"):
            break
        key, _, value = (part.strip() for part in row.text[1:].partition(":"))
        if key in CHOICES and value not in CHOICES[key]:
            raise row.error(f"`{key}` must be {' or '.join(CHOICES[key])}.")
        header[key] = value
    else:
        raise ValueError(
            f"Table `{path}` ends before the line with the names of its columns; it "
            f"is empty or cut off."
        )
    if "cosine" not in header:
        raise ValueError(
            f"The header of table `{path}` must say whether values hold the cosine "
            f"of theta_i: add the line `# cosine: not included` or "
            f"`# cosine: included`."
        )
    return header, row


def read_body(
    path: Path, rows: Iterator[text.Line], header: dict[str, str], names: text.Line
) -> np.ndarray:
    """The numbers below the names of the columns."""
    width = len(words(names.text))
    data = (row.text for row in rows if not row.text.startswith("#"))
    first = next(data, None)
    if first is None:
        raise ValueError(f"Table `{path}` holds no rows below its column names.")
    try:
        table = np.loadtxt(itertools.chain([first], data), delimiter=",", ndmin=2)
        if table.shape[1] != width:
            raise ValueError
    except ValueError:
        raise name_wrong_line(path, names, width) from None
    expected = header.get("rows", str(len(table)))
    if expected != str(len(table)):
        raise ValueError(
            f"Table `{path}` has {len(table)} rows, but its header says {expected}; it "
            f"is cut off, or was edited: then correct the line `# rows`."
        )
    return table.astype(header["precision"], copy=False)


def name_wrong_line(path: Path, names: text.Line, width: int) -> ValueError:
    """The error of the first line that is not ``width`` numbers."""
    for row in text.lines(path):
        if row.number <= names.number or row.text.startswith("#"):
            continue
        try:
            count = len(row.numbers(","))
        except ValueError as error:
            return error
        if count != width:
            return row.error(f"a row must hold {width} numbers, but this has {count}.")
    return ValueError(f"Table `{path}` could not be read as numbers.")


def read_directions(
    columns: dict[str, np.ndarray], header: dict[str, str], names: text.Line
) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors to light and viewer, from angles or from vectors."""
    if set(VECTORS) <= columns.keys():
        vectors = np.stack([columns[name] for name in VECTORS], axis=1)
        wi, wo = vectors[:, :3], vectors[:, 3:]
        worst = max(np.abs(np.linalg.norm(w, axis=1) - 1).max() for w in (wi, wo))
        if not worst < 1e-3:
            raise ValueError(
                f"Directions in `{names.path}` must be unit vectors, but the length of "
                f"one is off by {worst:.3g}."
            )
        return wi, wo
    if not set(ANGLES) <= columns.keys():
        raise names.error(
            f"the columns must include {', '.join(ANGLES)} or {', '.join(VECTORS)}."
        )
    if "angles" not in header:
        raise ValueError(
            f"The header of table `{names.path}` must give the unit of its angles: add "
            f"the line `# angles: degrees` or `# angles: radians`."
        )
    unit = np.pi / 180 if header["angles"] == "degrees" else 1.0
    theta_i, phi_i, theta_o, phi_o = (columns[name] * unit for name in ANGLES)
    if not np.isfinite([theta_i, phi_i, theta_o, phi_o]).all():
        raise ValueError(f"Angles in `{names.path}` must be finite numbers.")
    return directions(theta_i, phi_i), directions(theta_o, phi_o)


def read_channels(
    columns: dict[str, np.ndarray], header: dict[str, str], names: text.Line
) -> tuple[str, ...]:
    """Names of the channels: those that the header lists, or all other columns."""
    known = {*ANGLES, *VECTORS, "solid_angle"}
    rest = [name for name in columns if name not in known]
    rest = [
        name
        for name in rest
        if not any(name == prefix + other for prefix in PREFIXES for other in rest)
    ]
    channels = words(header["channels"]) if "channels" in header else rest
    missing = [channel for channel in channels if channel not in columns]
    if missing:
        raise names.error(
            f"the header promises channel `{missing[0]}`, not found here."
        )
    if not channels:
        raise names.error("there must be at least one column of reflectance.")
    allowed = {p + channel for p in ("", *PREFIXES) for channel in channels}
    for name in columns.keys() - known - allowed:
        raise names.error(f"column `{name}` is not known; see brdffit.readers.table.")
    return tuple(channels)
