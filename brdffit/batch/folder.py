"""Folders of files: everything fitted with everything, one folder a result.

A run leaves in its folder

- ``results.csv``, one row for each file and model, and the same as
  ``results.parquet`` where pyarrow is installed;
- ``index.html``, an overview with thumbnails that needs nothing else;
- ``fits/FILE/MODEL/`` with ``result.json`` and ``thumbnail.png``;
- ``ledger.jsonl``, by which a later run knows what is finished.
"""

import dataclasses
import functools
import hashlib
import shutil
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from brdffit.batch.ledger import Record, fingerprint, open_ledger, seal
from brdffit.batch.run import Outcome, run
from brdffit.batch.tally import Tally
from brdffit.catalogue import from_name
from brdffit.compiled import make_room
from brdffit.files import replacing, sentence
from brdffit.fit import RESIDUALS, fit
from brdffit.names import look_up
from brdffit.readers import load

FITS = "fits"
RESULT = "result.json"
THUMBNAIL = "thumbnail.png"
DOTS = 120  # of a thumbnail per inch

drawing = threading.Lock()  # settings of matplotlib are those of all threads


@dataclasses.dataclass(frozen=True)
class Batch:
    """What a run over files gave.

    Attributes:
        folder: Where everything is.
        rows: One for each file and model, in the order asked for; see `rows_of`.
        files: Table and overview.
        tally: How many fits were kept, done, and did not converge.
    """

    folder: Path
    rows: list[dict[str, Any]]
    files: list[Path]
    tally: Tally


@dataclasses.dataclass(frozen=True)
class Job:
    """One file and one model, and what an earlier run recorded about them."""

    file: Path
    model: str
    key: str
    record: Record | None


@dataclasses.dataclass(frozen=True)
class FitFile:
    """Fits a model to a file; the task that threads and workers are given.

    Attributes:
        folder: Of the run.
        reading: Options of `brdffit.load`.
        fitting: Options of `brdffit.fit`.
    """

    folder: Path
    reading: dict[str, Any]
    fitting: dict[str, Any]

    def __call__(self, job: Job) -> Outcome:
        """Keep what still holds, or else fit; a failure is an outcome as well."""
        make_room()
        home = self.folder / FITS / job.key
        files = [home / RESULT, home / THUMBNAIL]
        try:
            content = content_of(job.file)
            mark = fingerprint(content=content, model=job.model, **self.options)
            if job.record and job.record.holds(mark, files):
                return Outcome(job.key, 1, job.record, kept=True)
            shutil.rmtree(home, ignore_errors=True)
            data = _loaded(job.file, content, tuple(self.reading.items()))
            result = fit(job.model, data, **self.fitting)
        except Exception as error:  # of whatever kind, it must not stop the others
            known = isinstance(error, ValueError | OSError)
            kind = "" if known else f"{type(error).__name__}: "
            return Outcome(job.key, 1, None, failure=kind + sentence(error))
        home.mkdir(parents=True, exist_ok=True)
        result.save(home / RESULT)
        _draw(data, result, home / THUMBNAIL)
        facts = {"not_converged": int(not result.converged)}
        return Outcome(job.key, 1, Record(job.key, mark, seal(files), facts))

    @property
    def options(self) -> dict[str, Any]:
        """What, beside file and model, decides a result."""
        return {"reading": self.reading, "fitting": self.fitting}


def batch(
    files: Sequence[str | Path],
    models: Sequence[str],
    out: str | Path,
    *,
    residual: str | None = None,
    starts: int = 16,
    channels: Sequence[str] = (),
    illuminant: str | None = None,
    samples: int | None = None,
    resume: bool = False,
    cluster: str | None = None,
    on_progress: Callable[[Tally], None] | None = None,
) -> Batch:
    """Fit every model to every file.

    A file that cannot be read or fitted has a row with the reason and stops nothing;
    it is tried again when the run is resumed.

    Args:
        files: Files and folders that `brdffit.load` reads.
        models: Names of models and of sums.
        out: Folder of the run, made if it is not there.
        residual: What is compared; the default of `brdffit.fit` where None.
        starts: Number of starts of each fit.
        channels: Names of the channels to use; all by default.
        illuminant: Light under which spectral data become RGB.
        samples: Number of samples of a share that stands for all of a file.
        resume: Whether to go on with an earlier run in that folder, whose results are
            kept where file, model, options and version are the same and their checksum
            is right.
        cluster: Address of a Dask scheduler, whose workers see the same files under the
            same names; by default threads of this process.
        on_progress: Called after every fit.

    Raises:
        ValueError: An unknown model or residual, or no file or model.
        FileExistsError: The folder holds something and is not to be resumed.
        BlockingIOError: Another run has the folder.
        ConnectionError: The scheduler is not there, or went away.
        OSError: The folder cannot be written.
        KeyboardInterrupt: The run was interrupted; says how to go on.
    """
    from brdffit.batch.overview import write_overview
    from brdffit.batch.table import rows_of, write_table

    for model in models:
        from_name(model)
    if residual:
        look_up(RESIDUALS, residual, "Residual")
    if not files or not models:
        raise ValueError("A batch must be given at least one file and one model.")
    folder = Path(out).absolute()
    task = FitFile(
        folder,
        {"channels": tuple(channels), "illuminant": illuminant, "samples": samples},
        {"residual": residual, "starts": starts},
    )
    with open_ledger(folder, resume) as ledger:
        jobs = [
            Job(path, model, key := f"{name}/{model}", ledger.records.get(key))
            for name, path in names_of(files).items()
            for model in dict.fromkeys(models)
        ]
        tally = Tally("fits", len(jobs))
        failures = {
            outcome.key: outcome.failure
            for outcome in run(task, jobs, ledger, tally, cluster, on_progress)
        }
        rows = rows_of(folder, jobs, failures)
        written = [*write_table(folder, rows), write_overview(folder, rows, tally)]
    return Batch(folder, rows, written, tally)


def names_of(files: Sequence[str | Path]) -> dict[str, Path]:
    """Absolute paths by the name of their folder of results.

    That is the name of the file, with as many of the folders above it as keep it apart
    from the others.
    """
    paths = list(dict.fromkeys(Path(file).absolute() for file in files))
    depth, names = 1, []
    while len(set(names)) < len(paths):
        names = ["_".join(path.parts[1:][-depth:]) for path in paths]
        depth += 1
    return dict(zip(names, paths, strict=True))


def content_of(path: Path) -> str:
    """Hash of a file and the scene beside it, or of all files in a folder.

    Raises:
        OSError: It does not exist, or cannot be read.
    """
    inside = sorted(p for p in path.rglob("*") if p.is_file()) if path.is_dir() else []
    beside = [p for p in [path.with_suffix(".toml")] if p.is_file()]
    total = hashlib.sha256()
    for file in inside or [path, *beside]:
        total.update(str(file.relative_to(path.parent)).encode())
        with file.open("rb") as stream:
            total.update(hashlib.file_digest(stream, "sha256").digest())
    return total.hexdigest()


@functools.lru_cache(maxsize=2)
def _loaded(path: Path, content: str, reading: tuple[tuple[str, Any], ...]):
    """The data of a file, read once for several models."""
    del content  # another content is another entry
    return load(path, **dict(reading))


def _draw(data, result, path: Path) -> None:
    from brdffit.plots import thumbnail_figure

    with drawing, replacing(path) as temporary:
        thumbnail_figure(data, result).savefig(temporary, dpi=DOTS)
