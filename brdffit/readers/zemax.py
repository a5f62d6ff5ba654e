r"""Zemax BSDF text: a grid about the specular ray, for each angle of incidence.

The format (Rykowski, "BSDF Data Interchange file format", Radiant Imaging 2008) lists
its angles in a header and then, between ``DataBegin`` and ``DataEnd``, one block for
each sample rotation and angle of incidence: a line ``TIS`` with the total integrated
scatter, and one line of values for each azimuth, from the smallest radial angle to the
largest. Tristimulus files repeat that for X, Y and Z.

Radial angle and azimuth are polar coordinates about the *specular ray*: radial 0 is the
mirror direction, and azimuth 0 points from it towards the normal, which is towards the
back; angles are in degrees. With $s$ the specular ray, $b$ the unit vector of azimuth 0
and $y$ perpendicular to the plane of incidence,

$$\omega_o = s\cos r + (b \cos a + y \sin a) \sin r.$$

A value of zero means that there is no data; many such cells lie below the horizon.
"""

from pathlib import Path

import numpy as np

from brdffit.readers import text, validity
from brdffit.readers.angles import directions, finite
from brdffit.samples import Measurement

DESCRIPTION = "Zemax BSDF text: tabulated scatter about the specular ray"
SUFFIXES = (".bsdf",)
BEGINS = "with lines such as `Source Measured` and `Symmetry PlaneSymmetrical`"

GRID = ("SampleRotation", "AngleOfIncidence", "ScatterAzimuth", "ScatterRadial")
CHANNELS = {
    "Monochrome": {"Monochrome": "f_r"},
    "XYZ": {"TristimulusX": "X", "TristimulusY": "Y", "TristimulusZ": "Z"},
}

CHOICES = {
    "Source": ("Measured",),
    "Symmetry": (
        "PlaneSymmetrical",
        "Asymmetrical",
        "ASymmetrical",
        "Asymmetrical4D",
        "ASymmetrical4D",
    ),
    "SpectralContent": tuple(CHANNELS),
    "ScatterType": ("BRDF",),
}


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether lines that are no comments begin with labels of Zemax's header alone."""
    content = (line.split() for line in head.splitlines() if not line.startswith(b"#"))
    labels = [words[0] for words in content if words]
    return labels[:1] == [b"Source"] or b"AngleOfIncidence" in labels


def load(path: Path | str) -> Measurement:
    """Read all cells of a file of Zemax; those without data are masked.

    Raises:
        ValueError: The header or a value is wrong, the file is of transmission, or it
            is cut off.
        OSError: The file cannot be read.
    """
    words = text.Words(path)
    header, grid = read_header(words)
    sections = CHANNELS[header["SpectralContent"]]
    values = np.stack([read_section(words, name, grid) for name in sections], axis=-1)
    wi, wo = read_directions(*(np.deg2rad(grid[name]) for name in GRID))
    return validity.measurement(
        path,
        wi=wi.reshape(-1, 3),
        wo=wo.reshape(-1, 3),
        f_r=values,
        known=values != 0,
        channels=tuple(sections.values()),
        name=words.path.stem,
    )


def read_header(words: text.Words) -> tuple[dict[str, str], dict[str, np.ndarray]]:
    """The words and the lists of angles before the data."""
    header: dict[str, str] = {}
    grid: dict[str, np.ndarray] = {}
    while header.keys() != set(CHOICES) or grid.keys() != set(GRID):
        label = words.word(f"a label such as `{GRID[0]}`")
        if label in GRID:
            grid[label] = words.numbers(f"angles of {label}")
        elif label in CHOICES:
            header[label] = words.word(label)
            if header[label] not in CHOICES[label]:
                choices = " or ".join(CHOICES[label])
                raise words.line.error(f"{label} must be {choices} to be read.")
        else:
            raise words.line.error(f"`{label}` is no label of a Zemax header.")
    return header, grid


def read_section(
    words: text.Words, name: str, grid: dict[str, np.ndarray]
) -> np.ndarray:
    """Values of one channel, in the order of the grid."""
    rotation, incidence, azimuth, radial = (len(grid[label]) for label in GRID)
    expect(words, name)
    expect(words, "DataBegin")
    blocks = []
    for _ in range(rotation * incidence):
        expect(words, "TIS")
        words.number("total integrated scatter")
        blocks.append(words.numbers("values", azimuth * radial))
    expect(words, "DataEnd")
    return np.concatenate(blocks)


def expect(words: text.Words, label: str) -> None:
    """Refuse any word but ``label``."""
    if words.word(f"`{label}`") != label:
        raise words.line.error(f"`{label}` should stand here.")


def read_directions(
    rotation: np.ndarray, incidence: np.ndarray, azimuth: np.ndarray, radial: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """``wi`` and ``wo`` of every cell, shape ``(len of each..., 3)``."""
    angles = (finite(each) for each in (rotation, incidence, azimuth, radial))
    turn, theta, a, r = np.ix_(*angles)
    zero = np.zeros_like(turn + theta + a + r)
    # Where the light lies at azimuth 0 and the specular ray at azimuth 180 degrees:
    specular = directions(theta + zero, np.pi)
    back = directions(np.pi / 2 - theta + zero, 0.0)
    aside = directions(np.pi / 2 + zero, np.pi / 2)
    cos_r, sin_r, a = np.cos(r)[..., None], np.sin(r)[..., None], a[..., None]
    wo = specular * cos_r + (back * np.cos(a) + aside * np.sin(a)) * sin_r
    # A sample that is turned sees the light turned the other way.
    return rotate(directions(theta + zero, 0.0), -turn), rotate(wo, -turn)


def rotate(w: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Turn directions about the normal."""
    x, y, z = np.moveaxis(w, -1, 0)
    cos, sin = np.cos(phi), np.sin(phi)
    return np.stack([cos * x - sin * y, sin * x + cos * y, z + 0 * phi], axis=-1)
