"""Results as tables: of parameters, of residuals, of a ranking."""

from collections.abc import Iterator

from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

from brdffit.fit import FitResult
from brdffit.fit.numbers import LOST, rounded, rows
from brdffit.fit.select import Comparison, Entry

WORDY = (
    "parameters",
    "what it is",
    "why",
)  # columns of words, which may take several lines
MARKS = {"at bound": "{} *", LOST: "{} ?"}


def parameter_table(result: FitResult) -> Table:
    """Parameters with errors, units and legal intervals."""
    table = new_table("parameter", "value", "error", "unit", "range", "note")
    for row in rows(result):
        value, error = rounded(row.value, row.error)
        unit = "" if row.unit == "1" else row.unit
        table.add_row(row.title, value, error, unit, row.bounds, row.note)
    return table


def residual_table(result: FitResult) -> Table:
    """Root mean square under every residual, the minimised one marked."""
    table = new_table("residual", "root mean square", "")
    for name, rms in result.rms.items():
        mark = "minimised" if name == result.residual else ""
        table.add_row(name, f"{rms:#.4g}", mark)
    return table


def ranking_table(comparison: Comparison) -> Table:
    """The ranking, the best model first; models that tie with it are marked."""
    entries = comparison.entries
    lowest = min(entry.result.aicc for entry in entries)
    several = sum(entry.tied for entry in entries) > 1
    known = comparison.best.chi_square is not None
    shown = any(entry.colour for entry in entries)
    table = new_table(
        *("", "model", "", "held-out\nerror", "rms, all\ndata", "AICc above\nthe best"),
        *(["chi-square\nper value"] if known else []),
        *(["CIEDE\n2000", "Delta E\nITP"] if shown else []),
        *("free\nnumbers", "seconds"),
    )
    for place, entry in enumerate(entries, start=1):
        result = entry.result
        table.add_row(
            str(place),
            result.model,
            "tied" if several and entry.tied else "",
            f"{entry.held_out:#.4g}",
            f"{result.rms[comparison.residual]:#.4g}",
            f"{result.aicc - lowest:.4g}",
            *([f"{(result.chi_square or 0) / result.count:#.4g}"] if known else []),
            *(colours(entry) if shown else []),
            str(len(result.labels)),
            f"{result.seconds:.1f}",
        )
    return table


def colours(entry: Entry) -> tuple[str, str]:
    """Colour differences of an entry, to two decimals; empty where there are none."""
    if entry.colour is None:
        return "", ""
    return f"{entry.colour.ciede2000:.2f}", f"{entry.colour.itp:.2f}"


def side_by_side(comparison: Comparison, console: Console) -> Iterator[Table]:
    """Every model's parameters with errors: a row each, and a column for each model.

    As many tables as the width of the console asks for.
    """
    cells: dict[str, dict[str, str]] = {}
    for entry in comparison.entries:
        for row in rows(entry.result):
            value, error = rounded(row.value, row.error)
            text = f"{value} \N{PLUS-MINUS SIGN} {error}" if error else value
            text = MARKS.get(row.note, "{}").format(value if error == LOST else text)
            cells.setdefault(row.title, {})[entry.result.model] = text
    models = [entry.result.model for entry in comparison.entries]
    while models:
        count = len(models)
        while count > 1 and _width(cells, models[:count], console) > console.width:
            count -= 1
        yield _pivot(cells, models[:count])
        models = models[count:]


def _pivot(cells: dict[str, dict[str, str]], models: list[str]) -> Table:
    table = new_table("parameter", *models)
    for label, texts in cells.items():
        if any(model in texts for model in models):
            table.add_row(label, *(texts.get(model, "") for model in models))
    return table


def _width(cells, models: list[str], console: Console) -> int:
    unlimited = console.options.update(max_width=10_000)
    return Measurement.get(console, unlimited, _pivot(cells, models)).maximum


def new_table(*headings: str) -> Table:
    """An empty table in the look of all tables; no number is ever broken."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for heading in headings:
        table.add_column(heading, no_wrap=heading not in WORDY)
    return table
