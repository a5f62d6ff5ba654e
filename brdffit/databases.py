"""Materials of public databases, fetched by name: ``merl:NAME`` and ``rgl:NAME``.

A download that was interrupted goes on where it stopped; a file appears under its name
only when it is complete and of the right format. Neither database publishes checksums.
So the first download of a file is trusted, its SHA-256 is written into
``checksums.txt`` beside it, and every later one must have the same; who knows better
gives the checksum. The addresses are those under which the databases were published;
another one can be given where they have moved.

Source:
    W. Matusik, H. Pfister, M. Brand, L. McMillan, "A Data-Driven Reflectance Model",
    SIGGRAPH 2003; J. Dupuy and W. Jakob, "An Adaptive Parameterization for Efficient
    Material Acquisition and Rendering", SIGGRAPH Asia 2018.
"""

import dataclasses
import logging
import re
from collections.abc import Callable
from pathlib import Path

import platformdirs
import pooch

from brdffit.download import Progress, download
from brdffit.files import replacing, require_writable
from brdffit.names import look_up
from brdffit.readers import READERS, title

CHECKSUMS = "checksums.txt"
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*")


@dataclasses.dataclass(frozen=True)
class Database:
    """Where a database lives.

    Attributes:
        url: Address of its folder.
        file: Path of a material below it, with its name in place of ``{}``.
        home: Page for people, which lists the names.
    """

    url: str
    file: str
    home: str


DATABASES = {
    "merl": Database(
        "http://people.csail.mit.edu/wojciech/BRDFDatabase/brdfs/",
        "{}.binary",
        "https://www.merl.com/research/downloads/BRDF",
    ),
    "rgl": Database(
        "https://rgl.s3.eu-central-1.amazonaws.com/media/materials/",
        "{0}/{0}_rgb.bsdf",
        "https://rgl.epfl.ch/materials",
    ),
}


def fetch(
    material: str,
    folder: Path | str | None = None,
    *,
    url: str | None = None,
    checksum: str | None = None,
    progress: Progress | None = None,
) -> Path:
    """Path of a material's file, which is downloaded unless it is there already.

    Args:
        material: ``merl:NAME`` or ``rgl:NAME``.
        folder: Where to keep it; by default a folder for caches of the operating
            system.
        url: Address of the database's folder, in place of the one known.
        checksum: SHA-256 that the file must have, as hexadecimal digits.
        progress: Called with the bytes that are there and the number of all, or None
            while that is not known.

    Raises:
        ValueError: No such database, a wrong name, another checksum, or another format.
        OSError: The server cannot be reached, has no such file, or stopped half-way;
            or the file cannot be written.
    """
    kind, _, name = material.partition(":")
    database = look_up(DATABASES, kind, "Database")
    if not NAME.fullmatch(name):
        raise ValueError(
            f"Material `{material}` must be `{kind}:` and a name of letters, digits, "
            f"`-`, `_` or `.`, as listed at {database.home}."
        )
    place = database.file.format(name)
    file = Path(place).name
    folder = Path(folder or platformdirs.user_cache_path("brdffit") / kind)
    require_writable(folder)
    folder.mkdir(parents=True, exist_ok=True)
    known = checksum or recorded(folder).get(file)
    base = (url or database.url).rstrip("/") + "/"
    pooch.get_logger().setLevel(logging.ERROR)  # progress is shown by our own bar
    store = pooch.create(
        path=folder,
        base_url=base,
        registry={file: known and f"sha256:{known.removeprefix('sha256:').lower()}"},
        urls={file: base + place},
    )
    try:
        path = Path(store.fetch(file, downloader=_downloader(kind, database, progress)))
    except ValueError as error:
        if "hash" not in str(error):
            raise
        raise ValueError(
            f"`{material}` from {base + place} has another checksum than "
            f"{'was given' if checksum else f'{CHECKSUMS} in `{folder}` has'}; the "
            f"file was not kept. It is damaged, or has been replaced."
        ) from error
    record(folder, path)
    return path


def _downloader(
    kind: str, database: Database, progress: Progress | None
) -> Callable[..., None]:
    """What pooch calls with an address and the name of a temporary file."""
    reader = READERS[kind]

    def check(path: Path) -> None:
        with path.open("rb") as stream:
            head = stream.read(4096)
        if not reader.matches(path, head):
            raise ValueError(
                f"The server did not send a file of {title(reader)}, which begins "
                f"{reader.BEGINS}; see {database.home} for the names of materials."
            )

    def load(url: str, output_file: str, store: pooch.Pooch) -> None:
        part = Path(store.path) / f".{Path(url).name}.part"
        download(url, part, progress, hint=f"names are listed at {database.home}")
        try:
            check(part)
        except ValueError:
            part.unlink()
            raise
        part.replace(output_file)

    return load


def recorded(folder: Path) -> dict[str, str]:
    """SHA-256 by name of file, of the first download of each."""
    listing = folder / CHECKSUMS
    if not listing.is_file():
        return {}
    words = (line.split() for line in listing.read_text().splitlines())
    return {pair[1]: pair[0] for pair in words if len(pair) == 2}


def record(folder: Path, path: Path) -> None:
    """Write down the checksum of a file that is seen for the first time."""
    known = recorded(folder)
    if path.name not in known:
        known[path.name] = pooch.file_hash(str(path), alg="sha256")
        with replacing(folder / CHECKSUMS) as temporary:
            rows = (f"{checksum}  {name}\n" for name, checksum in sorted(known.items()))
            temporary.write_text("".join(rows))
