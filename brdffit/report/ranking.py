"""The ranking of a report, a row for each model."""

from typing import NamedTuple

from brdffit.fit.select import Comparison
from brdffit.report.formulas import printed
from brdffit.report.verdict import free_numbers
from brdffit.report.yardstick import Yardstick

MANY = 100  # AICc beyond which tenths say nothing


class Ranked(NamedTuple):
    """One model; ``bar`` is its error in percent of the largest."""

    name: str
    tied: bool
    error: str
    held_out: str
    bar: float
    rms: str
    aicc: str
    ciede2000: str
    free: int
    agreement: str
    seconds: str


def ranking(comparison: Comparison, yardstick: Yardstick) -> list[Ranked]:
    """Rows in the order of the ranking."""
    entries = comparison.entries
    lowest = min(entry.result.aicc for entry in entries)
    several = sum(entry.tied for entry in entries) > 1
    longest = max(entry.held_out for entry in entries) or 1.0
    return [
        Ranked(
            name=name,
            tied=several and entry.tied,
            error=yardstick.percent(entry.held_out),
            held_out=printed(f"{entry.held_out:#.3g}"),
            bar=round(100 * entry.held_out / longest, 1),
            rms=printed(f"{entry.result.rms[comparison.residual]:#.3g}"),
            aicc=f"{above:,.{1 if above < MANY else 0}f}",
            ciede2000=f"{entry.colour.ciede2000:.2f}" if entry.colour else "",
            free=free_numbers(entry.result),
            agreement=f"{round(entry.result.agreement * entry.result.starts)} of "
            f"{entry.result.starts}",
            seconds=f"{entry.result.seconds:.1f}",
        )
        for name, entry in zip(comparison.results, entries, strict=True)
        for above in [entry.result.aicc - lowest]
    ]
