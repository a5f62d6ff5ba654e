"""A comparison as CSV, for spreadsheets: the ranking, and all parameters."""

import csv
from collections.abc import Iterable, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

from brdffit.files import replacing
from brdffit.fit.numbers import rows
from brdffit.fit.select import Comparison


def write_tables(comparison: Comparison, folder: Path) -> list[Path]:
    """Write ``ranking.csv`` and ``parameters.csv``.

    Raises:
        OSError: A file cannot be written.
    """
    return [
        write_csv(folder / "ranking.csv", ranking_rows(comparison)),
        write_csv(folder / "parameters.csv", parameter_rows(comparison)),
    ]


def ranking_rows(comparison: Comparison) -> Iterable[Sequence[Any]]:
    """Heading and one row for each model, the best first."""
    residuals = list(comparison.best.rms)
    yield (
        *("rank", "model", "held_out_error", "tied", "aicc", "bic"),
        *(f"rms_{name}" for name in residuals),
        *("ciede2000", "delta_e_itp"),
        *("free_numbers", "converged", "seconds"),
    )
    for rank, entry in enumerate(comparison.entries, start=1):
        result = entry.result
        yield (
            *(rank, result.model, entry.held_out, entry.tied, result.aicc, result.bic),
            *(result.rms[name] for name in residuals),
            *(astuple(entry.colour) if entry.colour else ("", "")),
            *(len(result.labels), result.converged, result.seconds),
        )


def parameter_rows(comparison: Comparison) -> Iterable[Sequence[Any]]:
    """Heading and one row for each number of each model."""
    yield ("model", "parameter", "channel", "value", "standard_error", "unit", "note")
    for entry in comparison.entries:
        for row in rows(entry.result):
            yield (
                *(entry.result.model, row.label, row.channel),
                *(row.value, row.error, row.unit, row.note),
            )


def write_csv(path: Path, content: Iterable[Sequence[Any]]) -> Path:
    """Write rows of values; returns the path.

    Raises:
        OSError: The file cannot be written.
    """
    with replacing(path) as temporary, temporary.open("w", newline="") as stream:
        csv.writer(stream).writerows(content)
    return path
