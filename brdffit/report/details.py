"""One model of a report: its parameters, their correlation, how they were found."""

from typing import NamedTuple

import matplotlib
import numpy as np
from markupsafe import Markup
from matplotlib.colors import to_hex

from brdffit.fit import RESIDUALS, FitResult
from brdffit.fit.numbers import LOST, Row, known_parameters, rounded, rows
from brdffit.plots.style import DIVERGING
from brdffit.report.embed import embed_pixels
from brdffit.report.formulas import as_html, printed

MOST = 14  # parameters whose correlations are written out
STRONG = 0.8  # correlation that a reader should know of
PAIRS = 6  # strongest correlations that are told
PALE = 0.56  # share of the colour scale that leaves black figures legible
WORDS = {"at bound": "at its bound", LOST: "not determined", "held": "held"}


class Number(NamedTuple):
    """A row of the table of parameters; ``place`` is in percent of the legal range."""

    row: Row
    symbol: Markup
    value: str
    error: str
    note: str
    place: float | None


class Cell(NamedTuple):
    """A correlation: its figure and the colour behind it."""

    figure: str
    colour: str


class Correlation(NamedTuple):
    """Correlations of the errors.

    Attributes:
        titles: Name of each row.
        cells: Lower triangle, when there are few parameters.
        picture: The whole matrix as a data URI, when there are many.
        strongest: Pairs of titles with their correlation, those that matter.
    """

    titles: list[str]
    cells: list[list[Cell]]
    picture: str
    strongest: list[tuple[str, str, str]]


class Error(NamedTuple):
    """Root mean square under one residual."""

    name: str
    quantity: Markup
    rms: str
    minimised: bool


def numbers(result: FitResult) -> list[Number]:
    """Every parameter with its error, unit, legal range and a word of warning."""
    known = known_parameters(result)
    found = []
    for row in rows(result):
        value, error = rounded(row.value, row.error)
        parameter = known[row.label.partition("[")[0]]
        low, high = parameter.lower, parameter.upper
        ends = np.isfinite([low, high]).all() and high > low
        place = 100 * (row.value - low) / (high - low) if ends else None
        found.append(
            Number(
                row,
                as_html(f"${parameter.symbol}$"),
                printed(value),
                "" if error == LOST else printed(error),
                WORDS.get(row.note, ""),
                place,
            )
        )
    return found


def correlation(result: FitResult) -> Correlation:
    """Correlations in colours, blue for below and red for above 0."""
    matrix = np.asarray(result.correlation, float)
    titles = [row.title for row in rows(result)]
    scale = matplotlib.colormaps[DIVERGING]
    colours = scale(0.5 + PALE * matrix / 2)
    low = np.tril_indices(len(matrix), -1)
    order = np.argsort(-np.abs(matrix[low]))[:PAIRS]
    strongest = [
        (titles[column], titles[row], printed(f"{matrix[row, column]:+.2f}"))
        for row, column in zip(low[0][order], low[1][order], strict=True)
        if abs(matrix[row, column]) >= STRONG
    ]
    if len(titles) > MOST:
        pixels = np.round(255 * colours).astype(np.uint8)
        return Correlation(titles, [], embed_pixels(pixels), strongest)
    cells = [
        [
            Cell(
                printed(f"{matrix[row, column]:.2f}"),
                to_hex(colours[row, column]),
            )
            for column in range(row + 1)
        ]
        for row in range(len(titles))
    ]
    return Correlation(titles, cells, "", strongest)


def errors_by_residual(result: FitResult) -> list[Error]:
    """The error under each residual, that which was minimised marked."""
    return [
        Error(
            name,
            as_html(RESIDUALS[name].label),
            printed(f"{rms:.4g}"),
            name == result.residual,
        )
        for name, rms in result.rms.items()
    ]
