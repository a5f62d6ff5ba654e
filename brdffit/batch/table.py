"""The table of a batch: one row for each file and model.

CSV is always written, as everything reads it. Where pyarrow is installed the same rows
are written as Parquet too, which keeps types and is quick to read in bulk.
"""

import csv
import importlib.util
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from brdffit.batch.folder import FITS, RESULT, Job
from brdffit.files import replacing
from brdffit.fit import FitResult, load_result
from brdffit.fit.numbers import rows as numbers

Rows = list[dict[str, Any]]


def rows_of(folder: Path, jobs: Sequence[Job], failures: Mapping[str, str]) -> Rows:
    """A row for each job: how the fit went, and its parameters with standard errors.

    A row lacks the parameters that its model does not have; one that failed has a
    sentence and no result.
    """
    rows = []
    for job in jobs:
        row: dict[str, Any] = {
            "file": job.key.rpartition("/")[0],
            "model": job.model,
            "path": str(job.file),
            "failure": failures.get(job.key, ""),
        }
        if not row["failure"]:
            row |= _facts(load_result(folder / FITS / job.key / RESULT))
        rows.append(row)
    best: dict[str, Any] = {}
    for row in rows:
        if "aicc" in row:
            best[row["path"]] = min(row["aicc"], best.get(row["path"], row["aicc"]))
    for row in rows:
        if "aicc" in row:
            row["aicc_above_best"] = row["aicc"] - best[row["path"]]
    return rows


def _facts(result: FitResult) -> dict[str, Any]:
    facts: dict[str, Any] = {
        "converged": result.converged,
        "residual": result.residual,
        "rms": result.rms[result.residual],
        "explained": result.explained,
        "aicc": result.aicc,
        "aicc_above_best": 0.0,
        "bic": result.bic,
        "count": result.count,
        "masked": result.masked,
        "agreement": result.agreement,
        "at_bound": " ".join(result.at_bound),
        "undetermined": " ".join(result.undetermined),
        "seconds": result.seconds,
    }
    for row in numbers(result):
        name = row.label.partition("[")[0]
        name += f"_{row.channel}" if row.channel else ""
        facts |= {name: row.value, f"{name}_error": row.error}
    return facts


def write_table(folder: Path, rows: Rows) -> list[Path]:
    """Write ``results.csv``, and ``results.parquet`` where pyarrow is installed.

    Raises:
        OSError: A file cannot be written.
    """
    columns = list(dict.fromkeys(name for row in rows for name in row))
    written = [folder / "results.csv"]
    with replacing(written[0]) as temporary, temporary.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, columns)
        writer.writeheader()
        writer.writerows(rows)
    if importlib.util.find_spec("pyarrow"):
        import pyarrow
        from pyarrow import parquet

        written.append(folder / "results.parquet")
        whole = [{name: row.get(name) for name in columns} for row in rows]
        with replacing(written[-1]) as temporary:
            parquet.write_table(pyarrow.Table.from_pylist(whole), temporary)
    return written
