"""Figures of benchmarks: the time of each contestant, one panel per case."""

from collections.abc import Sequence

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from brdffit.plots.style import COLOURS, MUTED, new_figure
from experiments.record import styled

WIDTH, LINE = 4.6, 0.21  # inches of a panel and of a contestant


@styled
def dots(rows, keys: Sequence[str], what: str = "fit", columns: int = 2):
    """Median time of every contestant, the fastest on top, with a line over its turns.

    brdffit is coloured; contestants with a wrong answer are named so.

    Args:
        rows: Lines of the table.
        keys: Columns that tell the cases apart.
        what: What the time is taken of.
        columns: Panels beside each other.
    """
    cases = list(dict.fromkeys(tuple(row[key] for key in keys) for row in rows))
    most = max(sum(_case(row, keys) == case for row in rows) for case in cases)
    lines = -(-len(cases) // columns)
    columns = min(columns, len(cases))
    figure = new_figure(WIDTH * columns, (0.8 + LINE * most) * lines)
    panels = figure.subplots(lines, columns, squeeze=False).ravel()
    for axes, case in zip(panels, cases, strict=False):
        _panel(axes, [row for row in rows if _case(row, keys) == case])
        axes.set_xlabel(f"processor time of one {what} [ms], log scale")
        axes.set_title(_title(keys, case))
    for axes in panels[len(cases) :]:
        axes.set_axis_off()
    return figure


def _case(row, keys):
    return tuple(row[key] for key in keys)


def _title(keys, case) -> str:
    words = []
    for key, value in zip(keys, case, strict=True):
        if isinstance(value, str):
            words.append(value)
        else:
            words.append(f"{value:,} {key if value != 1 else key.rstrip('s')}")
    return ", ".join(words)


def _panel(axes, rows) -> None:
    rows = sorted(rows, key=lambda row: row["ms"])
    times = np.array([row["ms"] for row in rows])
    names = [
        row["contestant"] + ("" if row["answer"] == "right" else " (wrong answer)")
        for row in rows
    ]
    for place, row in enumerate(rows):
        own = row["contestant"].startswith("brdffit")
        colour = COLOURS[0] if own else MUTED
        ends = row["least_ms"], row["most_ms"]
        axes.plot(ends, (place, place), color=colour, linewidth=1)
        axes.plot(row["ms"], place, "o", color=colour, markersize=5)
    axes.set_yticks(range(len(rows)), names)
    for place, time in enumerate(times):
        axes.annotate(
            f"{time:,.3g}" if time < 1000 else f"{time:,.0f}",
            (time, place),
            xytext=(0, 4),
            textcoords="offset points",
            ha="center",
            size=7,
        )
    axes.set(xscale="log", ylim=(len(rows) - 0.5, -0.9))
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 3)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
