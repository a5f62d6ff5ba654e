"""Residuals: where a fit is off, against angles of light, viewer and half vector."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from brdffit.fit import RESIDUALS, FitResult
from brdffit.fit.misfit import misfit
from brdffit.names import look_up
from brdffit.plots.plane import polar
from brdffit.plots.style import COLOURS, MUTED, entitle, new_figure, styled
from brdffit.samples import Measurement, Samples, as_samples
from brdffit.types import Values

MODELS = 4  # most models, a row each
POINTS = 4000  # most values drawn in a panel
BINS = 18  # of median and band
FEWEST = 5  # values that make a bin
LARGEST = 99.0  # percentile of the errors at which the axis ends
BAND = (16, 50, 84)  # percentiles; a normal error is within one standard deviation


@styled
def residuals_figure(
    data: Measurement | Samples, results: Mapping[str, FitResult]
) -> Figure:
    """Residual of every value that was used against three angles, a row for each fit.

    Args:
        data: What was fitted.
        results: Fits by the name to show, the best first; four are shown.

    Raises:
        ValueError: A fit under a residual that is not in `RESIDUALS`.
    """
    samples = as_samples(data)
    shown = dict(list(results.items())[:MODELS])
    residual = look_up(RESIDUALS, next(iter(shown.values())).residual, "Residual")
    errors = {n: misfit(r.brdf, samples, residual) for n, r in shown.items()}
    sizes = np.abs(np.concatenate(list(errors.values())))
    limit = float(np.nanpercentile(sizes, LARGEST)) or 1.0

    figure = new_figure(9.0, 1.0 + 1.6 * len(shown))
    angles = sample_angles(samples)
    grid = figure.subplots(
        len(shown), len(angles), squeeze=False, sharex="col", sharey=True
    )
    for row, (name, error) in zip(grid, errors.items(), strict=True):
        for axes, (label, angle) in zip(row, angles.items(), strict=True):
            plot_residuals(axes, angle, error, limit)
            axes.set_xlabel(label)
            axes.label_outer()
        row[0].set_ylabel(name)
        beyond = np.mean(np.abs(error[np.isfinite(error)]) > limit)
        if beyond:
            note = f"{beyond:.2%} of the values lie beyond the axis"
            row[-1].set_title(note, size=7, color=MUTED, loc="right", pad=2)
    figure.legend(
        *grid[0, 0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=3,
        markerscale=3,
    )
    figure.supylabel(f"fitted - measured {residual.label}", size=9)
    best = f", the best {len(shown)} of {len(results)} models"
    entitle(
        figure,
        f"{data.name}: residual against angle"
        f"{best if len(shown) < len(results) else ''}",
    )
    return figure


def plot_residuals(
    axes: Axes,
    angle: Float[np.ndarray, " sample"],
    error: Values,
    limit: float,
) -> None:
    """Draw errors of all channels against one angle, with their median and spread.

    Args:
        axes: Where to draw.
        angle: Angle of each sample in degrees.
        error: Error of each value, NaN where there is none.
        limit: End of the axis in both directions.
    """
    here = np.isfinite(error)
    x, y = np.broadcast_to(angle[:, None], error.shape)[here], error[here]
    drawn = np.random.default_rng(0).permutation(len(x))[:POINTS]
    axes.plot(
        x[drawn],
        y[drawn],
        ".",
        ms=2.2,
        mec="none",
        mfc=MUTED,
        alpha=0.7,
        rasterized=True,
        zorder=2.2,
        label="values" if len(x) <= POINTS else f"values ({POINTS} of {len(x)})",
    )
    edges = np.linspace(x.min(), x.max(), BINS + 1)
    place = np.clip(np.digitize(x, edges) - 1, 0, BINS - 1)
    full = [bin for bin in range(BINS) if np.count_nonzero(place == bin) >= FEWEST]
    if full:
        middle = [np.mean(x[place == bin]) for bin in full]
        low, median, high = np.transpose(
            [np.percentile(y[place == bin], BAND) for bin in full]
        )
        axes.fill_between(
            middle,
            low,
            high,
            color=COLOURS[-1],
            alpha=0.35,
            lw=0,
            label="from the 16th to the 84th percentile",
        )
        axes.plot(middle, median, color=COLOURS[0], label="median", zorder=2.4)
    axes.axhline(0, color=MUTED, lw=0.8)
    axes.set_ylim(-limit, limit)


def sample_angles(samples: Samples) -> dict[str, np.ndarray]:
    """Angles of each sample in degrees, by their label.

    Under several lights those of the one that can add most.
    """
    brightest = np.asarray(samples.weight).sum(axis=2).argmax(axis=1)
    wi = np.asarray(samples.wi)[np.arange(len(samples)), brightest]
    wo = np.asarray(samples.wo)
    note = ", brightest light" if samples.wi.shape[1] > 1 else ""
    return {
        rf"$\theta_i$ [degrees]{note}": polar(wi)[0],
        r"$\theta_o$ [degrees]": polar(wo)[0],
        rf"$\theta_h$ [degrees]{note}": polar(wi + wo)[0],
    }
