"""``brdffit fetch``: a material of a public database."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import Json


def fetch(
    material: Annotated[str, Parameter("merl:NAME|rgl:NAME")],
    /,
    *,
    out: Annotated[Path | None, Parameter("--out")] = None,
    url: str | None = None,
    checksum: str | None = None,
    as_json: Json = False,
) -> None:
    """Download a material of the MERL or of the RGL database, and say where it is.

    An interrupted download goes on where it stopped. The databases publish no
    checksums: that of the first download is kept beside the file and must stay.

    Args:
        material: Database and name, as in merl:gold-metallic-paint.
        out: Folder for the file. [a folder for caches]
        url: Address of the folder of the database, where it has moved.
        checksum: SHA-256 that the file must have.
    """
    with console.transfer(material) as progress:
        path = brdffit.fetch(
            material, out, url=url, checksum=checksum, progress=progress
        )
    if as_json:
        console.print_json({"file": str(path)})
    else:
        console.print_line(f"{material} is at {path}.")
