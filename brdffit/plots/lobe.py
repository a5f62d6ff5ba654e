"""Lobes: reflectance against angle in one plane, data and fits."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from brdffit.fit import FitResult
from brdffit.models import AbstractBRDF
from brdffit.names import look_up
from brdffit.plots.plane import Plane, planes
from brdffit.plots.style import (
    DATA,
    MUTED,
    entitle,
    legend,
    lines,
    new_figure,
    spread,
    styled,
)
from brdffit.render.shading import compiled_shade
from brdffit.samples import Measurement, Samples, as_samples

PANELS = 4  # most panels side by side
MODELS = 5  # most models in one panel
HEADROOM = 1.6  # times the highest sample that a linear scale leaves for models
POINTS = 1500  # most samples in a panel, evenly spread
MANY = 120  # samples in a panel beyond which their marks are small


@styled
def lobe_figure(
    data: Measurement | Samples,
    results: Mapping[str, FitResult],
    channel: str | None = None,
) -> Figure:
    """Lobes of data and fits, on a linear scale above and a logarithmic one below.

    Args:
        data: What was fitted.
        results: Fits by the name to show, the best first; five are drawn.
        channel: Channel to show; by default the middle one, which is green in RGB.

    Raises:
        ValueError: The data have no plane to show, or no such channel.
    """
    found = spread(planes(data), PANELS)
    if not found:
        raise ValueError(
            f"Data `{data.name}` must have samples in a plane of incidence under a "
            "single light to show lobes, but have none."
        )
    names = as_samples(data).channels
    places = {name: place for place, name in enumerate(names)}
    place = look_up(places, channel or names[len(names) // 2], "Channel")
    shown = dict(list(results.items())[:MODELS])
    models = {name: result.brdf for name, result in shown.items()}

    figure = new_figure(1.6 + 2.3 * max(len(found), 2), 5.4)
    above, below = figure.subplots(2, len(found), squeeze=False, sharex="col")
    for panel, logarithmic_panel, plane in zip(above, below, found, strict=True):
        plot_lobe(panel, plane, models, place)
        plot_lobe(logarithmic_panel, plane, models, place, logarithmic=True)
        panel.set(title=plane.title, xlabel="")
    lowest, highest = np.array([panel.get_ylim() for panel in below]).T
    for panel in below:
        panel.set_ylim(lowest.min(), highest.max())
        panel.label_outer()
    for panel in above[1:]:
        panel.set_ylabel("")
    legend(figure, above[0])
    title = f"{data.name}: measured and fitted lobes"
    if len(names) > 1:
        title += f", channel {names[place]}"
    if len(shown) < len(results):
        title += f", the best {len(shown)} of {len(results)} models"
    entitle(figure, title)
    return figure


def plot_lobe(
    axes: Axes,
    plane: Plane,
    models: Mapping[str, AbstractBRDF],
    channel: int = 0,
    *,
    logarithmic: bool = False,
) -> None:
    """Draw one plane: samples as circles, models as lines, the mirror angle dotted.

    The linear scale ends at twice the highest sample at most; where a model goes beyond
    it, the logarithmic scale shows how far.
    """
    used = np.flatnonzero(np.isfinite(plane.f_r[:, channel]))
    drawn = spread(used.tolist(), POINTS)
    measured = plane.f_r[drawn, channel]
    few = len(drawn) <= MANY
    marks = {"mfc": "none", "ms": 3.5} if few else {"mfc": DATA, "ms": 1.6}
    axes.plot(
        plane.angle[drawn],
        measured,
        "o",
        mec=DATA,
        mew=0.6,
        label="measured",
        zorder=1,
        **marks,
    )
    highest = np.max(measured, initial=0)
    for (name, brdf), line in zip(models.items(), lines(len(models)), strict=True):
        value = predicted(brdf, plane)[:, channel]
        highest = np.nanmax([highest, *value])
        axes.plot(plane.curve, value, label=name, **line)
    axes.axvline(plane.mirror, color=MUTED, lw=0.8, ls=":", zorder=0)
    if logarithmic:
        axes.set_yscale("log")
        axes.set_ylim(np.min(measured[measured > 0], initial=highest) / 2, 2 * highest)
        label_decimals(axes)
    else:
        top = np.max(measured, initial=0)
        axes.set_ylim(0, 1.2 * min(max(top, highest), HEADROOM * top) or 1)
    scale = ", log scale" if logarithmic else ""
    axes.set(xlabel=plane.label, ylabel=rf"$f_r$ [1/sr]{scale}")
    axes.set_xticks(np.arange(-90, 91, 30))


def predicted(brdf: AbstractBRDF, plane: Plane) -> np.ndarray:
    """Reflectance of a model along the curve, NaN where it is 0 below the horizon."""
    nothing = np.zeros((len(plane.curve), plane.f_r.shape[1]))
    where = as_samples(Measurement(plane.wi, plane.wo, nothing))
    value = np.asarray(compiled_shade(brdf, where))
    return np.where(value > 0, value, np.nan)


def label_decimals(axes: Axes) -> None:
    """Label a logarithmic axis with plain numbers, within a few decades 2 and 5 too."""

    def minor(value: float, _: int) -> str:
        low, high = axes.get_ylim()
        wanted = f"{value:e}"[0] in "25" and high < 100 * low
        return f"{value:g}" if wanted else ""

    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(FuncFormatter(minor))
