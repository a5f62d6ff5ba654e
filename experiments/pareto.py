"""Figures of error against time, with the Pareto front and a name at every point."""

import math

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from brdffit.plots.style import COLOURS, MUTED, entitle, new_figure
from experiments.labels import label_points
from experiments.record import styled
from experiments.tradeoff import front

MARKS = ("o", "s", "^", "D", "v", "P", "X", "*")
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
SHOWN = {"us": "µs"}
PANEL = 3.7, 3.1  # inches
ROOM = 0.16  # of the range of a panel that is left free on either side, for names


@styled
def chart(
    rows,
    titles,
    finding,
    *,
    unit,
    error,
    time_of,
    columns=3,
    label=None,
    panel=PANEL,
):
    """Error against time, a panel for each question, the Pareto front drawn.

    Args:
        rows: Lines of the table.
        titles: What each question found, by question.
        finding: Title of the whole.
        unit: Of time, a key of `UNITS`.
        error: What the error is, with its unit.
        time_of: What the time is taken of.
        columns: Panels beside each other.
        label: From a row to the name beside its point; by default that of the variant.
            Variants without any error are upright lines.
        panel: Width and height of a panel in inches.
    """
    columns = min(columns, len(titles))
    lines = -(-len(titles) // columns)
    figure = new_figure(panel[0] * columns, panel[1] * lines + 0.6)
    panels = figure.subplots(lines, columns, squeeze=False).ravel()
    finished = []
    for axes, (question, title) in zip(panels, titles.items(), strict=False):
        own = [row for row in rows if row["question"] == question]
        exact = [row for row in own if row["error"] == 0]
        own = [row for row in own if 0 < row["error"] < math.inf]
        for row in exact:
            where = row["seconds"] / UNITS[unit]
            axes.axvline(where, color="black", ls=":", lw=1, label=row["variant"])
        finished.append((axes, own, draw(axes, own, unit, legend=label is None)))
        stretch(axes, [row["seconds"] / UNITS[unit] for row in exact])
        axes.set_title(title, size=8.5)
        axes.set_ylabel(f"{error}, log scale", size=8)
        unit_shown = SHOWN.get(unit, unit)
        axes.set_xlabel(f"time of {time_of} [{unit_shown}], log scale", size=8)
    for axes in panels[len(titles) :]:
        axes.set_axis_off()
    entitle(figure, finding)
    handles = {}
    for axes, *_ in finished:
        handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(
        handles.values(), handles, loc="outside lower center", ncols=4, fontsize=8
    )
    figure.draw_without_rendering()  # the layout is final
    for axes, own, line in finished:
        name = label or (lambda row: row["variant"])
        points = [(r["seconds"] / UNITS[unit], r["error"]) for r in own]
        upright = [line.get_xdata()[0] for line in axes.lines if line.get_ls() == ":"]
        heights = np.geomspace(*axes.get_ylim(), 200)
        line = [*line, *((x, y) for x in upright for y in heights)]
        crowded = label_points(axes, points, [name(row) for row in own], line)
        if crowded:
            print("No room in the figure for:", *crowded)
    return figure


def draw(axes, rows, unit, legend):
    """Points, lines of families and the front; returns positions along the lines."""
    best = front(rows)
    x = np.array([row["seconds"] for row in best]) / UNITS[unit]
    y = np.array([row["error"] for row in best])
    axes.plot(
        x, y, color=MUTED, lw=4, alpha=0.3, zorder=1, label="Pareto front (filled)"
    )
    line = [_between(x, y)]
    families = list(dict.fromkeys(row["family"] for row in rows))
    for place, family in enumerate(families):
        own = [row for row in rows if row["family"] == family]
        colour, mark = COLOURS[place % len(COLOURS)], MARKS[place % len(MARKS)]
        if legend and len(own) > 1 and len(families) > 1:
            axes.plot([], [], f"{mark}-", color=colour, ms=5.5, lw=1, label=family)
        for row in own:
            ends = row["lower_quartile"], row["upper_quartile"]
            axes.plot(np.divide(ends, UNITS[unit]), [row["error"]] * 2, color=colour)
            axes.plot(
                row["seconds"] / UNITS[unit],
                row["error"],
                mark,
                color=colour,
                mfc=colour if row in best else "white",
                ms=5.5,
                zorder=4,
            )
        if len(own) > 1:
            x = np.array([row["seconds"] for row in own]) / UNITS[unit]
            y = np.array([row["error"] for row in own])
            axes.plot(x, y, color=colour, lw=1, zorder=2)
            line.append(_between(x, y))
    logarithmic(axes, rows, unit)
    return np.concatenate(line)


def _between(x, y):
    """Positions along a line that is straight on logarithmic axes."""
    places = np.linspace(0, len(x) - 1, 40 * max(len(x) - 1, 1))
    known = np.arange(len(x))
    logs = [np.interp(places, known, np.log(each)) for each in (x, y)]
    return np.exp(np.stack(logs, axis=1))


def stretch(axes, positions):
    """Make room for upright lines."""
    low, high = axes.get_xlim()
    for x in positions:
        low, high = min(low, x / 1.2), max(high, x * 1.2)
    axes.set_xlim(low, high)


def logarithmic(axes, rows, unit):
    """Logarithmic axes with plain numbers and room for names."""
    axes.set(xscale="log", yscale="log")
    for of, values in (
        ("x", [row["seconds"] / UNITS[unit] for row in rows]),
        ("y", [row["error"] for row in rows]),
    ):
        low, high = np.log(min(values)), np.log(max(values))
        margin = ROOM * max(high - low, 1.5)
        getattr(axes, f"set_{of}lim")(np.exp(low - margin), np.exp(high + margin))
        label_plainly(getattr(axes, f"{of}axis"))


def label_plainly(axis):
    """Label a logarithmic axis, whose limits are set, with plain numbers."""
    decades = float(np.diff(np.log10(axis.get_view_interval()))[0])
    axis.set_major_locator(LogLocator(subs=ticks(decades), numticks=10))
    axis.set_major_formatter(FuncFormatter(plain))
    axis.set_minor_locator(NullLocator())


def ticks(decades):
    """First digits of the numbers at an axis that spans so many factors of ten."""
    if decades < 0.8:
        return (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8)
    return (1, 2, 5) if decades < 2.5 else (1,)


def plain(value, _=None):
    """A number at an axis, with a power of ten where it is very small or large."""
    if 1e-3 < 1.001 * value < 1e5:
        return f"{value:,.6g}"
    power = math.floor(math.log10(value * (1 + 1e-9)))
    digits = f"{value / 10**power:.3g}"
    ten = f"10^{{{power}}}"
    return f"${ten}$" if digits == "1" else rf"${digits} \times {ten}$"
