"""What accuracy costs in time: the variants of a question, all measured alike.

A variant is run once, which compiles it and gives its error; then all variants of a
question take turns (see `benchmarks.measure`), and its time is the median of its turns.
On one core, to which an experiment keeps itself by `use_one_core`, that is processor
time, which the load of the machine hardly changes.
"""

import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from benchmarks.measure import Contestant, Entry, take_turns


@dataclasses.dataclass(frozen=True)
class Variant:
    """One way to answer a question.

    Attributes:
        name: What it is called in tables and figures.
        run: Answers, and returns when it is done.
        error: Of an answer, against a reference of higher precision.
        family: Variants of one family differ by a number and are joined by a line.
    """

    name: str
    run: Callable[[], Any]
    error: Callable[[Any], float]
    family: str = ""


def measured(
    question: str, variants: Sequence[Variant], turns: int, share: float = 1
) -> list[dict]:
    """Lines of a table, one for each variant.

    The time of the first run beyond that of others is told apart, as that of compiling;
    it is close to 0 where an earlier variant has the same program.

    Args:
        question: What they answer.
        variants: The first is the one that others are compared with.
        turns: Number of turns.
        share: What one answer is of all that a run gives, when it gives many.
    """
    entries = [_first_run(variant) for variant in variants]
    take_turns(entries, turns)
    rows = []
    for variant, entry in zip(variants, entries, strict=True):
        low, middle, high = share * np.quantile(entry.seconds, [0.25, 0.5, 0.75])
        rows.append(
            {
                "question": question,
                "variant": variant.name,
                "family": variant.family or variant.name,
                "error": entry.excess,
                "seconds": float(middle),
                "lower_quartile": float(low),
                "upper_quartile": float(high),
                "compile_seconds": max(0.0, entry.first - middle / share),
            }
        )
    for row in rows:
        row["on_front"] = row in front(rows)
    return rows


def _first_run(variant: Variant) -> Entry:
    """A variant with its error, the first run behind it."""
    begin = time.perf_counter()
    answer = variant.run()
    first = time.perf_counter() - begin
    contestant = Contestant(variant.name, lambda _: (variant.run(), 0))
    return Entry(contestant, 0.0, 0, float(variant.error(answer)), first)


def front(rows: Sequence[dict]) -> list[dict]:
    """The rows that no other beats in both time and error, the fastest first."""
    best, found = math.inf, []
    for row in sorted(rows, key=lambda row: (row["seconds"], row["error"])):
        if row["error"] < best:
            best = row["error"]
            found.append(row)
    return found


def root_mean_square(truth) -> Callable[[Any], float]:
    """Error of an array: root mean square of its difference over that of the truth."""
    wanted = np.asarray(truth, np.float64)

    def error(found) -> float:
        difference = np.asarray(found, np.float64) - wanted
        return float(np.sqrt(np.mean(difference**2) / np.mean(wanted**2)))

    return error


def saved(row: dict, reference: dict) -> str:
    """How the time of a variant compares, as words with a number."""
    ratio = row["seconds"] / reference["seconds"]
    if ratio >= 2:
        return f"takes {rounded(ratio)} times the time"
    if ratio > 1:
        return f"takes {100 * (ratio - 1):.0f} % more time"
    return f"saves {100 * (1 - ratio):.0f} % of the time"


def rounded(value):
    """A number to two digits, without an exponent."""
    return f"{float(f'{value:.2g}'):,.10g}"
