"""Ranking: the models of a comparison as a table, with bars of their held-out error."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from brdffit.fit.residual import RESIDUALS
from brdffit.fit.select import Comparison
from brdffit.plots.style import COLOURS, NO_DATA, entitle, new_figure, styled

HEADINGS = {  # right edge of each column, in widths of the table
    "held-out\nerror": 0.19,
    "error, all\ndirections": 0.40,
    "AICc above\nthe best": 0.63,
    "free\nnumbers": 0.79,
    "seconds": 0.96,
}


@styled
def ranking_figure(comparison: Comparison) -> Figure:
    """The ranking as a table; bars of models that tie with the winner are hatched."""
    figure = new_figure(9.0, 1.5 + 0.28 * len(comparison.entries))
    bars, table = figure.subplots(1, 2, width_ratios=(5, 6), sharey=True)
    plot_errors(bars, comparison)
    plot_table(table, comparison)
    entitle(
        figure,
        f"{comparison.data}: models ranked by their error on "
        f"{comparison.held_out_count} held-out directions",
    )
    return figure


def plot_errors(axes: Axes, comparison: Comparison) -> None:
    """Draw the held-out error of each model as a bar, the best on top."""
    entries = comparison.entries
    tied = [entry.tied for entry in entries]
    several = sum(tied) > 1
    names = [
        f"{entry.result.model} (tied)" if several and entry.tied else entry.result.model
        for entry in entries
    ]
    axes.barh(
        range(len(entries)),
        [entry.held_out for entry in entries],
        color=[COLOURS[0] if best else NO_DATA for best in tied],
        hatch=["///" if several and best else "" for best in tied],
        edgecolor="white",
        height=0.7,
    )
    axes.set_yticks(range(len(entries)), names)
    axes.set_ylim(len(entries) - 0.5, -1.2)  # the best on top, room for headings
    axes.grid(visible=False, axis="y")
    label = RESIDUALS[comparison.residual].label
    axes.set_xlabel(f"root mean square error of {label}")


def plot_table(axes: Axes, comparison: Comparison) -> None:
    """Write the numbers of each model in the rows of `plot_errors`."""
    best = min(entry.result.aicc for entry in comparison.entries)
    rows = [
        (
            f"{entry.held_out:#.4g}",
            f"{entry.result.rms[comparison.residual]:#.4g}",
            f"{entry.result.aicc - best:,.1f}",
            f"{len(entry.result.labels)}",
            f"{entry.result.seconds:.1f}",
        )
        for entry in comparison.entries
    ]
    axes.set_axis_off()
    axes.set_xlim(0, 1)
    for column, (heading, right) in enumerate(HEADINGS.items()):
        axes.text(right, -0.8, heading, ha="right", va="center", weight="bold", size=8)
        for row, words in enumerate(rows):
            axes.text(right, row, words[column], ha="right", va="center")
