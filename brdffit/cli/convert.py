"""``brdffit convert``: a measurement in another format."""

from pathlib import Path

from brdffit.cli import console
from brdffit.cli.options import Channels, Illuminant, Json


def convert(
    source: Path,
    out: Path,
    /,
    *,
    channels: Channels = None,
    illuminant: Illuminant = None,
    as_json: Json = False,
) -> None:
    """Write a measurement as a table (.csv), as MERL binary, or as an image (.exr).

    Materials of MERL and RGL, which are known at all directions, can become either; the
    image is that of a sphere under one light. Other data become tables.

    Args:
        source: File or folder of any format that brdffit reads.
        out: File to write; its suffix decides the format.
    """
    from brdffit.cli.inputs import read_data
    from brdffit.conversion import convert as write
    from brdffit.files import require_writable

    require_writable(out.parent)
    with console.progress(2) as step:
        step(f"reading {source.name}")
        data = read_data(source, channels, illuminant)
        step(f"writing {out.name}")
        out.parent.mkdir(parents=True, exist_ok=True)
        sentence = write(source, data, out, illuminant)
    if as_json:
        console.print_json({"file": str(out), "written": sentence})
    else:
        console.print_line(sentence)
        console.print_written([out])
