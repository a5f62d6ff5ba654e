"""The overview of a batch: one page that needs no other file and no network."""

import base64
from datetime import timedelta
from pathlib import Path

from brdffit.batch.folder import FITS, RESULT, THUMBNAIL
from brdffit.batch.table import Rows
from brdffit.batch.tally import Tally
from brdffit.files import replacing

TEMPLATE = "overview.html"


def write_overview(folder: Path, rows: Rows, tally: Tally) -> Path:
    """Write ``index.html``; returns its path.

    Raises:
        OSError: The file cannot be written.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    templates = Environment(
        loader=PackageLoader("brdffit.batch", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    text = templates.get_template(TEMPLATE).render(
        rows=[row | _shown(folder, row) for row in rows],
        title=folder.name,
        files=len({row["path"] for row in rows}),
        models=len({row["model"] for row in rows}),
        failed=sum(bool(row["failure"]) for row in rows),
        not_converged=sum(row.get("converged") is False for row in rows),
        tally=tally,
        time=timedelta(seconds=round(tally.seconds)),
    )
    path = folder / "index.html"
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return path


def _shown(folder: Path, row: dict) -> dict[str, str]:
    """The thumbnail of a row as data, and where its result lies; or why it failed."""
    if row["failure"]:
        reason, stop, more = row["failure"].partition(". ")
        return {"reason": reason + stop, "more": more}
    home = Path(FITS, row["file"], row["model"])
    picture = base64.b64encode((folder / home / THUMBNAIL).read_bytes()).decode()
    return {
        "thumbnail": f"data:image/png;base64,{picture}",
        "result": (home / RESULT).as_posix(),
    }
