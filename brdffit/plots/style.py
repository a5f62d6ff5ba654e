"""The look of all figures.

Colours are those of Okabe and Ito, which colour-blind readers tell apart; each has its
own line style, which a black-and-white print keeps apart. Figures are made without
pyplot: nothing is opened, and no setting of matplotlib is changed for others.
"""

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from brdffit.files import replacing

Item = TypeVar("Item")

DATA = "#000000"
MUTED = "#6b6b6b"
NO_DATA = "#b9b9b9"
DIVERGING = "RdBu_r"
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
DASHES = (
    "-",
    (0, (5, 1.5)),
    (0, (4, 1.2, 1, 1.2)),
    (0, (1, 1)),
    (0, (7, 1.2, 1, 1.2, 1, 1.2)),
    (0, (2.5, 1)),
)
FORMATS = ("png", "pdf")
CHARACTERS = 12  # of a title, per inch
RESOLUTION = 150  # dots per inch of a PNG

LOOK: Any = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "figure.titlesize": 11,
    "legend.fontsize": 9,
    "legend.frameon": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.7,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "lines.linewidth": 1.5,
    "pdf.fonttype": 42,  # text stays text
}

styled = matplotlib.rc_context(LOOK)
"""Decorator of functions that make a figure."""


def lines(count: int) -> list[dict[str, Any]]:
    """Options of ``Axes.plot`` for so many models, the best first.

    There are six looks. Better ones lie on top and are thinner, so that curves which
    coincide are all seen.
    """
    looks = list(zip(COLOURS, DASHES, strict=True))
    return [
        {
            "color": looks[number % len(looks)][0],
            "linestyle": looks[number % len(looks)][1],
            "linewidth": 1.3 + 0.35 * number,
            "zorder": 3 - number / count,
        }
        for number in range(count)
    ]


def legend(figure: Figure, axes: Axes) -> None:
    """What the lines of all panels mean, below them, in as few rows as fit."""
    handles, labels = axes.get_legend_handles_labels()
    room = figure.get_figwidth() / (0.7 + 0.09 * max(len(label) for label in labels))
    rows = -(-len(labels) // max(int(room), 1))
    figure.legend(
        handles, labels, loc="outside lower center", ncols=-(-len(labels) // rows)
    )


def spread(items: Sequence[Item], count: int) -> list[Item]:
    """At most so many of the items, evenly spread, the first and last included."""
    if len(items) <= count:
        return list(items)
    return [items[int(i)] for i in np.linspace(0, len(items) - 1, count).round()]


def new_figure(width: float, height: float) -> Figure:
    """An empty figure, sized in inches, whose parts make room for each other."""
    return Figure((width, height), layout="constrained")


def entitle(figure: Figure, words: str) -> None:
    """Set the title of a figure, in as many lines as its width asks for.

    A sentence loses its full stop, as titles have none.
    """
    room = int(CHARACTERS * figure.get_figwidth())
    plain = words.removesuffix(".").replace("$", r"\$")  # names of data are no formulas
    figure.suptitle("\n".join(textwrap.wrap(plain, room)))


def save(figure: Figure, folder: Path, name: str) -> list[Path]:
    """Write a figure as PNG and PDF, and return the two files.

    Raises:
        OSError: A file cannot be written.
    """
    written = [folder / f"{name}.{suffix}" for suffix in FORMATS]
    for path in written:
        with replacing(path) as temporary, matplotlib.rc_context(LOOK):
            figure.savefig(temporary, dpi=RESOLUTION)
        figure.set_layout_engine("none")  # once laid out, so in every format
    return written
