"""``brdffit batch``: many files, many models, resumable."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import (
    Channels,
    Cluster,
    Illuminant,
    Json,
    Resume,
    Share,
    chosen_models,
    words,
)


def batch(
    files: Annotated[tuple[Path, ...], Parameter(consume_multiple=True)],
    /,
    *,
    models: str,
    out: Annotated[Path, Parameter("--out")],
    residual: str | None = None,
    starts: int = 16,
    channels: Channels = None,
    illuminant: Illuminant = None,
    samples: Share = None,
    resume: Resume = False,
    cluster: Cluster = None,
    as_json: Json = False,
) -> int:
    """Fit every model to every file: a table, an overview and a folder a result.

    Exit status: 0 done, 1 a fit failed or did not converge, 2 bad input, 130
    interrupted.

    Args:
        files: Files and folders that brdffit fit reads.
        models: Names with commas between them, or all; a + makes a sum.
        out: Folder of the run; new, or with --resume that of an earlier one.
        residual: What is compared. [log for reflectance, cosine_weighted for images]
        starts: Number of starts, spread over typical ranges. [16]
    """
    from brdffit.fit.result import plain

    brdffit.enable_compilation_cache()
    with console.tally_bar() as show:
        done = brdffit.batch(
            files,
            chosen_models(models),
            out,
            residual=residual,
            starts=starts,
            channels=words(channels or ""),
            illuminant=illuminant,
            samples=samples,
            resume=resume,
            cluster=cluster,
            on_progress=show,
        )
    if as_json:
        written = [str(path) for path in done.files]
        console.print_json({"rows": plain(done.rows), "files": written})
    else:
        failures: dict[tuple[str, str], list[str]] = {}
        for row in done.rows:
            if row["failure"]:
                group = failures.setdefault((row["file"], row["failure"]), [])
                group.append(row["model"])
        for (file, failure), failing in failures.items():
            console.print_line(f"{file}, {', '.join(failing)}: {failure}")
        console.print_line(done.tally.sentence)
        console.print_written(done.files)
    return 1 if done.tally.failed or done.tally.not_converged else 0
