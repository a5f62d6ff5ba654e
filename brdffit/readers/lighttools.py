"""LightTools BSDF text: blocks of scatter about the normal, for each incidence.

After a header that lists ``ScatterAzimuth`` and ``ScatterRadial`` in degrees comes
``DataBegin``, then blocks such as::

    AOI 30 POI 0 Side Front Wavelength 550 ScatterType BRDF
    TIS 0.08
    0.031 0.030 0.029

with a value for each radial angle at the first azimuth, then at the next. Radial angles
count from the normal. AOI is the angle of incidence, and POI turns the plane of
incidence about the normal from the plane of y and z, so that light with POI 0 comes
from azimuth 90 degrees and its mirror direction is azimuth 270.

Only blocks of reflection (BRDF) at the front side are read. Several wavelengths, or the
``TristimulusValue`` of XYZ files, become channels.
"""

from pathlib import Path

import numpy as np

from brdffit.readers import text, validity
from brdffit.readers.angles import directions
from brdffit.samples import Measurement

DESCRIPTION = "LightTools BSDF text: tabulated scatter about the normal"
SUFFIXES = (".bsdf",)
BEGINS = "with lines such as `Symmetry Asymmetric` and `SpectralContent Monochrome`"

GRID = ("ScatterAzimuth", "ScatterRadial")
HEADER = ("Symmetry", "SpectralContent", "Source", "ScatterType", "Version")
NUMBERS = ("AOI", "POI", "Wavelength", "TIS")
WORDS = ("Side", "ScatterType", "TristimulusValue")

Block = dict[str, float | str]


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether the header lists scatter angles, and blocks begin with AOI."""
    content = (line.split() for line in head.splitlines() if not line.startswith(b"#"))
    first = [words[0] for words in content if words]
    return b"ScatterRadial" in first and (
        b"AOI" in first or first[0] in (b"Symmetry", b"SpectralContent")
    )


def load(path: Path | str) -> Measurement:
    """Read the reflection at the front side.

    Raises:
        ValueError: A label or value is wrong, a block is missing for a channel, or the
            file is cut off.
        OSError: The file cannot be read.
    """
    words = text.Words(path)
    azimuth, radial = read_header(words)
    blocks = [
        (block, values)
        for block, values in read_blocks(words, azimuth.size * radial.size)
        if block.get("Side", "Front") == "Front" and block.get("ScatterType") == "BRDF"
    ]
    if not blocks:
        raise ValueError(
            f"LightTools file `{words.path}` holds no reflection at the front side."
        )
    incidence = list(dict.fromkeys(place(block) for block, _ in blocks))
    channels = tuple(dict.fromkeys(channel(block) for block, _ in blocks))
    found = {(place(block), channel(block)): values for block, values in blocks}
    missing = [
        (light, name)
        for light in incidence
        for name in channels
        if (light, name) not in found
    ]
    if missing or len(found) < len(blocks):
        raise ValueError(
            f"LightTools file `{words.path}` must have one block for each incidence "
            f"and channel, but has {len(blocks)} blocks for {len(incidence)} x "
            f"{len(channels)}."
        )
    theta_i, phi_i = np.deg2rad(np.array(incidence)).T
    phi_o, theta_o = (a.ravel() for a in np.meshgrid(azimuth, radial, indexing="ij"))
    viewers = directions(np.deg2rad(theta_o), np.deg2rad(phi_o))
    return validity.measurement(
        words.path,
        wi=np.repeat(directions(theta_i, phi_i + np.pi / 2), len(viewers), axis=0),
        wo=np.tile(viewers, (len(incidence), 1)),
        f_r=np.concatenate(
            [
                np.stack([found[light, name] for name in channels], axis=1)
                for light in incidence
            ]
        ),
        channels=channels if len(channels) > 1 else ("f_r",),
        name=words.path.stem,
    )


def place(block: Block) -> tuple[float, float]:
    """Angle and plane of incidence of a block, in degrees."""
    return float(block.get("AOI", np.nan)), float(block.get("POI", 0.0))


def channel(block: Block) -> str:
    """Name of the channel of a block."""
    tristimulus = str(block.get("TristimulusValue", ""))
    return tristimulus.removeprefix("Tris") or f"{block.get('Wavelength', 0.0):g} nm"


def read_header(words: text.Words) -> tuple[np.ndarray, np.ndarray]:
    """Azimuths and radial angles, in degrees."""
    grid: dict[str, np.ndarray] = {}
    while (label := words.word("`DataBegin`")) != "DataBegin":
        if label in GRID:
            grid[label] = words.numbers(f"angles of {label}")
        elif label in HEADER:
            words.word(label)
        else:
            raise words.line.error(f"`{label}` is no label of a LightTools header.")
    if len(grid) < len(GRID):
        raise words.line.error(f"the header must list {' and '.join(GRID)} before.")
    return grid["ScatterAzimuth"], grid["ScatterRadial"]


def read_blocks(words: text.Words, count: int) -> list[tuple[Block, np.ndarray]]:
    """What each block says of itself, and its values."""
    blocks: list[tuple[Block, np.ndarray]] = []
    block: Block = {}
    while (label := words.word("`DataEnd`")) != "DataEnd":
        if label in NUMBERS:
            block[label] = words.number(label)
        elif label in WORDS:
            block[label] = words.word(label)
        else:
            raise words.line.error(f"`{label}` is no label of a LightTools block.")
        if label == "TIS":
            if "AOI" not in block:
                raise words.line.error("a block must give its AOI before its values.")
            blocks.append((block, words.numbers("values", count)))
            block = {}
    return blocks
