"""CUReT: 61 materials under the same 205 pairs of directions.

The Columbia-Utrecht database (Dana, van Ginneken, Nayar, Koenderink 1999) keeps two
text files in one folder. ``abrdf.dat`` has a line for each material: its number and 205
values of reflectance in 1/sr, the mean of red, green and blue. ``table.txt`` has a line
for each pair: its number and, in radians, polar angle and azimuth of the viewer, then
of the light. Both directions leave the surface.

The noise of dark pairs makes some values negative; they are kept and masked.
"""

from pathlib import Path

from brdffit.readers import text, validity
from brdffit.readers.angles import directions
from brdffit.samples import Measurement

DESCRIPTION = "CUReT: materials of abrdf.dat with the directions of table.txt"
SUFFIXES = (".dat",)
BEGINS = "with a line of 206 numbers, and has table.txt beside it"

VALUES, ANGLES = "abrdf.dat", "table.txt"
PAIRS = 205


def matches(path: Path, head: bytes) -> bool:
    """Whether a folder holds both files, or a file is the one with the values."""
    if path.is_dir():
        return (path / VALUES).is_file() and (path / ANGLES).is_file()
    first = head.partition(b"\n")[0].split()
    return len(first) == PAIRS + 1 and (path.parent / ANGLES).is_file()


def load(path: Path | str, sample: int | None = None) -> Measurement:
    """Read one material, or all of them as channels that share their directions.

    Args:
        path: The folder, or the file with the values.
        sample: Number of a material, from 1; None for all.

    Raises:
        ValueError: A line is wrong, or there is no such material.
        OSError: A file cannot be read.
    """
    path = Path(path)
    path = path / VALUES if path.is_dir() else path
    values = text.table(path, text.lines(path), PAIRS + 1)
    angles = path.parent / ANGLES
    table = text.table(angles, text.lines(angles), 5)
    if len(table) != PAIRS:
        raise ValueError(f"`{angles}` must have {PAIRS} lines, but has {len(table)}.")
    numbers, f_r = values[:, 0], values[:, 1:].T
    names = [f"{number:g}" for number in numbers]
    if sample is not None:
        if str(sample) not in names:
            raise ValueError(
                f"`{path}` holds no sample {sample}; it has {names[0]} to {names[-1]}."
            )
        chosen = names.index(str(sample))
        names, f_r = names[chosen : chosen + 1], f_r[:, chosen : chosen + 1]
    _, theta_o, phi_o, theta_i, phi_i = table.T
    return validity.measurement(
        path,
        wi=directions(theta_i, phi_i),
        wo=directions(theta_o, phi_o),
        f_r=f_r,
        channels=tuple(names),
        name="CUReT" if sample is None else f"CUReT sample {sample}",
    )
