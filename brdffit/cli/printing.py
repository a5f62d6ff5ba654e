"""A fit or a comparison printed for people."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from brdffit.cli.console import output, print_written
from brdffit.cli.tables import (
    parameter_table,
    ranking_table,
    residual_table,
    side_by_side,
)
from brdffit.fit import FitResult
from brdffit.fit.select import TIE, Comparison


def print_fit(result: FitResult, written: Sequence[Path]) -> None:
    """Parameters with errors, what is not known about them, residuals, how it went."""
    console = output()
    left_out = f", {result.masked} left out" if result.masked else ""
    console.print(
        f"{result.model} fitted to {result.data}: {result.count} values{left_out}, "
        f"residual {result.residual}."
    )
    console.print()
    console.print(parameter_table(result))
    console.print()
    console.print(residual_table(result))
    console.print()
    if result.chi_square is not None and result.p_value is not None:
        console.print(
            f"Chi-square is {result.chi_square:.4g} for {result.count} values with "
            f"known errors; a larger one has probability {result.p_value:.2g}."
        )
    print_doubts(console, result)
    console.print(result.status)
    console.print(f"Path: {result.path}. Time: {result.seconds:.1f} s.")
    print_written(written)


def print_comparison(comparison: Comparison, written: Sequence[Path]) -> None:
    """The ranking, and the parameters of every model side by side."""
    console = output()
    console.print(
        f"Models fitted to {comparison.data} under the residual {comparison.residual}, "
        f"ranked by its root mean square on {comparison.held_out_count} directions "
        f"held out (seed {comparison.seed})."
    )
    console.print()
    console.print(ranking_table(comparison))
    console.print()
    for table in side_by_side(comparison, console):
        console.print(table)
        console.print()
    console.print(
        "Errors are one standard deviation. * at a bound; ? not determined by the data."
    )
    tied = [entry.result.model for entry in comparison.entries if entry.tied]
    if len(tied) > 1:
        console.print(
            f"{', '.join(tied)} are tied: their held-out errors differ by less than "
            f"{TIE:g} standard errors."
        )
    for entry in comparison.entries:
        print_doubts(console, entry.result, f"{entry.result.model}: ")
        if not entry.result.converged:
            console.print(f"{entry.result.model}: {entry.result.status}")
    print_written(written)


def print_doubts(console: Console, result: FitResult, prefix: str = "") -> None:
    """What is at a bound and what the data cannot tell, each sentence once."""
    sentences = [*result.at_bound.values(), *result.undetermined.values()]
    for sentence in dict.fromkeys(sentences):
        console.print(f"{prefix}{sentence}")
