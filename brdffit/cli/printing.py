"""A fit or a comparison printed for people."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from brdffit.cli.console import output, print_line, print_written
from brdffit.cli.tables import (
    new_table,
    parameter_table,
    ranking_table,
    residual_table,
    side_by_side,
)
from brdffit.fit import FitResult
from brdffit.fit.bootstrap import Bootstrap
from brdffit.fit.profile import Profile
from brdffit.fit.select import TIE, Comparison


def print_fit(result: FitResult, written: Sequence[Path]) -> None:
    """Parameters with errors, what is not known about them, residuals, how it went."""
    console = output()
    left_out = f", {result.masked} left out" if result.masked else ""
    print_line(
        f"{result.model} fitted to {result.data}: {result.count} values{left_out}, "
        f"residual {result.residual}{f', loss {result.loss}' if result.loss else ''}."
    )
    print_line()
    console.print(parameter_table(result))
    print_line()
    console.print(residual_table(result))
    print_line()
    if result.chi_square is not None and result.p_value is not None:
        print_line(
            f"Chi-square is {result.chi_square:.4g} for {result.count} values with "
            f"known errors; a larger one has probability {result.p_value:.2g}."
        )
    print_doubts(result)
    print_line(result.status)
    print_line(f"Path: {result.path}. Time: {result.seconds:.1f} s.")
    print_written(written)


def print_intervals(
    profile: Profile | None = None, bootstrap: Bootstrap | None = None
) -> None:
    """95 % intervals that do not take the cost for a parabola."""
    if profile is not None:
        low, high = profile.interval
        print_line(
            f"Profile: {profile.name} lies between {low:.4g} and {high:.4g} with 95 % "
            "confidence."
        )
    if bootstrap is not None:
        count = len(next(iter(bootstrap.parameters.values())))
        table = new_table("parameter", "95 % from", "to", "error")
        for name, ends in bootstrap.intervals.items():
            errors = np.atleast_1d(bootstrap.standard_errors[name])
            for place, (low, high) in enumerate(
                zip(*map(np.atleast_1d, ends), strict=True)
            ):
                label = name if len(errors) == 1 else f"{name}[{place}]"
                row = low, high, errors[place]
                table.add_row(label, *(f"{number:.4g}" for number in row))
        print_line(f"Residual bootstrap, {count} resamples:")
        print_line()
        output().print(table)


def print_comparison(comparison: Comparison, written: Sequence[Path]) -> None:
    """The ranking, and the parameters of every model side by side."""
    console = output()
    print_line(
        f"Models fitted to {comparison.data} under the residual {comparison.residual}, "
        f"ranked by its root mean square on {comparison.held_out_count} directions "
        f"held out (seed {comparison.seed})."
    )
    print_line()
    console.print(ranking_table(comparison))
    print_line()
    for table in side_by_side(comparison, console):
        console.print(table)
        print_line()
    print_line(
        "Errors are one standard deviation. * at a bound; ? not determined by the data."
    )
    tied = [entry.result.model for entry in comparison.entries if entry.tied]
    if len(tied) > 1:
        print_line(
            f"{', '.join(tied)} are tied: their held-out errors differ by less than "
            f"{TIE:g} standard errors."
        )
    if comparison.second_lobe:
        print_line(comparison.second_lobe)
    for entry in comparison.entries:
        print_doubts(entry.result, f"{entry.result.model}: ")
        if not entry.result.converged:
            print_line(f"{entry.result.model}: {entry.result.status}")
    print_written(written)


def print_doubts(result: FitResult, prefix: str = "") -> None:
    """What is at a bound and what the data cannot tell, each sentence once."""
    sentences = [*result.at_bound.values(), *result.undetermined.values()]
    for sentence in dict.fromkeys(sentences):
        print_line(f"{prefix}{sentence}")
