"""Readers of measured reflectance, one file format per file.

To add a format, write ``readers/<name>.py`` with

- ``DESCRIPTION``, one line about the format;
- ``SUFFIXES`` of its file names and what its content ``BEGINS`` with, for hints;
- ``matches(path, head)``, whether a file with these first bytes is of the format;
- ``load(path)``, which returns a Measurement or Samples;

and add its line below. The content decides, never the name of a file.
"""

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

from brdffit.readers import (
    astm,
    curet,
    exr_stack,
    fred,
    lighttools,
    merl,
    nist_ptfe,
    rgl,
    sphere_exr,
    sphere_photos,
    table,
    utia,
    zemax,
)
from brdffit.samples import Measurement, Samples, pick_channels
from brdffit.spectrum import to_rgb
from brdffit.subset import subset

HEAD = 65536  # bytes that a reader may look at to know its format


READERS: dict[str, ModuleType] = {
    "table": table,
    "fred": fred,
    "zemax": zemax,
    "lighttools": lighttools,
    "astm": astm,
    "nist_ptfe": nist_ptfe,
    "curet": curet,
    "merl": merl,
    "rgl": rgl,
    "utia": utia,
    "sphere_exr": sphere_exr,
    "sphere_photos": sphere_photos,
    "exr_stack": exr_stack,
}


def load(
    path: Path | str,
    *,
    channels: Sequence[str] = (),
    illuminant: str | None = None,
    samples: int | None = None,
) -> Measurement | Samples:
    """Read a measurement; the content of the file or folder decides its format.

    Args:
        path: File or folder.
        channels: Names of the channels to use; all by default.
        illuminant: Light under which spectral data become RGB, before channels are
            picked; see `to_rgb`.
        samples: Number of samples of a share that stands for all; see `subset`.

    Raises:
        ValueError: The content is of no known format, or is wrong, or has no such
            channel.
        OSError: The file cannot be read.
    """
    data = READERS[format_of(path)].load(path)
    if illuminant:
        data = to_rgb(data, illuminant)
    if channels:
        data = pick_channels(data, channels)
    return data if samples is None else subset(data, samples)


def format_of(path: Path | str) -> str:
    """Name of the reader that reads this file or folder.

    Raises:
        ValueError: The content is of no known format.
        OSError: The file cannot be read.
    """
    path = Path(path)
    if not path.exists():
        raise FileNotFoundError(f"File `{path}` does not exist; check its name.")
    head = b""
    if path.is_file():
        with path.open("rb") as stream:
            head = stream.read(HEAD)
        if not head:
            raise ValueError(f"File `{path}` is empty.")
    for name, reader in READERS.items():
        if reader.matches(path, head):
            return name
    near = [r for r in READERS.values() if path.suffix.lower() in r.SUFFIXES]
    hints = [f"{title(reader)}, which begins {reader.BEGINS}" for reader in near]
    hint = f" Its name is like that of {'; or of '.join(hints)}." if near else ""
    raise ValueError(
        f"`{path}` is not a measurement that brdffit can read.{hint} It reads: "
        f"{', '.join(title(reader) for reader in READERS.values())}."
    )


def title(reader: ModuleType) -> str:
    """What a format is called."""
    return reader.DESCRIPTION.partition(":")[0].partition(",")[0]
