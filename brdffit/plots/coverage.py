"""Coverage: which directions a measurement holds, and how often."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, Stroke
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from brdffit.plots.plane import polar
from brdffit.plots.style import MUTED, entitle, new_figure, styled
from brdffit.readers.validity import HORIZON
from brdffit.samples import Measurement, Samples, as_samples
from brdffit.types import Vectors

CELLS = 45  # across a panel
RINGS = (30, 60, 90)  # degrees
DECADE = 10  # samples in a cell, below which the scale names its numbers
MOST = 2_000_000  # samples that are counted


@styled
def coverage_figure(data: Measurement | Samples) -> Figure:
    """Directions to the light, to the viewer, and angles of half and difference.

    Only samples of which a value may be used count. Hemispheres are seen from above in
    equal areas; a colour is the number of samples in a cell.
    """
    samples = as_samples(data)
    use = np.asarray(samples.wo[:, 2] > HORIZON)
    if samples.mask is not None:
        use &= np.asarray(samples.mask).any(axis=1)
    rows = np.flatnonzero(use)
    if len(rows) > MOST:
        rows = np.random.default_rng(0).choice(rows, MOST, replace=False)
    samples = samples.take(rows)
    lights = samples.wi.shape[1]
    wi = np.asarray(samples.wi, float).reshape(-1, 3)
    wo = np.repeat(np.asarray(samples.wo, float), lights, axis=0)
    lit = wi[:, 2] > HORIZON
    wi, wo = wi[lit], wo[lit]

    figure = new_figure(9.0, 3.6)
    light, viewer, angles = figure.subplots(1, 3, width_ratios=(1, 1, 1.05))
    drawn = [
        plot_hemisphere(light, wi, r"to the light, $\omega_i$"),
        plot_hemisphere(viewer, wo, r"to the viewer, $\omega_o$"),
        plot_angles(angles, wi, wo),
    ]
    top = max(2.0, *(np.max(np.asarray(cells.get_array())) for cells in drawn))
    for cells in drawn:
        cells.set_norm(LogNorm(1, top))
    bar = figure.colorbar(drawn[-1], ax=[light, viewer, angles], shrink=0.8)
    bar.set_label("samples in a cell")
    bar.ax.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    if top < DECADE:
        bar.set_ticks(sorted({1, 2, 5, int(top)} & set(range(int(top) + 1))))
    entitle(figure, f"{samples.name}: directions of {len(samples)} samples")
    return figure


def plot_hemisphere(axes: Axes, w: Vectors, title: str) -> PolyCollection:
    """Count directions on the hemisphere seen from above, in equal areas."""
    theta, phi = polar(w)
    radius = np.sqrt(2) * np.sin(np.radians(theta) / 2)
    turn = np.radians(phi)
    cells = axes.hexbin(
        radius * np.cos(turn),
        radius * np.sin(turn),
        gridsize=CELLS,
        extent=(-1, 1, -1, 1),
        mincnt=1,
        linewidths=0.1,
    )
    circle = np.linspace(0, 2 * np.pi, 200)
    for ring in RINGS:
        size = np.sqrt(2) * np.sin(np.radians(ring) / 2)
        axes.plot(size * np.cos(circle), size * np.sin(circle), color=MUTED, lw=0.6)
        axes.annotate(
            rf"{ring}$\degree$",
            (0, -size),
            size=7,
            color=MUTED,
            ha="center",
            va="top",
            path_effects=[Stroke(linewidth=2.5, foreground="white"), Normal()],
        )
    axes.annotate(r"$\phi = 0$", (1.02, 0), size=7, color=MUTED, va="center")
    axes.set(aspect="equal", xlim=(-1.05, 1.3), ylim=(-1.2, 1.05), title=title)
    axes.set_axis_off()
    return cells


def plot_angles(axes: Axes, wi: Vectors, wo: Vectors) -> PolyCollection:
    """Count samples by angle of half vector and of difference."""
    half, _ = polar(wi + wo)
    difference = np.degrees(np.arccos(np.clip(np.sum(wi * wo, axis=1), -1, 1))) / 2
    cells = axes.hexbin(
        half,
        difference,
        gridsize=CELLS,
        extent=(0, 90, 0, 90),
        mincnt=1,
        linewidths=0.1,
    )
    axes.set(
        xlim=(0, 90),
        ylim=(0, 90),
        aspect="equal",
        xlabel=r"$\theta_h$, half vector to normal [degrees]",
        ylabel=r"$\theta_d$, light to half vector [degrees]",
        title="half and difference angles",
    )
    axes.set_xticks(range(0, 91, 30))
    axes.set_yticks(range(0, 91, 30))
    return cells
