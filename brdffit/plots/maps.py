"""Maps of a textured surface: every parameter with its error, and how the fits went.

One sheet shows them all. What has three channels is shown in its colours, with greys
beside it that tell the numbers; everything else in false colours with a scale.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import ListedColormap, LogNorm, Normalize, to_rgba
from matplotlib.figure import Figure

from brdffit import images
from brdffit.models.base import RGB, AbstractBRDF
from brdffit.parameters import Parameter, parameters
from brdffit.plots.style import COLOURS, NO_DATA, entitle, new_figure, styled

Map = Float[np.ndarray, "row column channel"]

WIDTH = 3.0  # inches of a panel
TALLEST = 1.2  # times its width that a panel is high at most
ENDS = (1, 99)  # percentiles at which scales end
DECADE = 10  # ratio of the ends from which on a logarithmic parameter has such a scale
PIXELS = 512  # of a map that are shown at most in each direction
STATES = {
    "converged": "#dfe7ec",
    "converged\nat a bound": COLOURS[4],
    "not converged": COLOURS[1],
}


@styled
def maps_figure(brdf: AbstractBRDF, maps: Mapping[str, Map], name: str) -> Figure:
    """A sheet of all maps; pixels without a texel are NaN and stay empty.

    Args:
        brdf: The model, whose parameters say symbol, unit and scale.
        maps: By name: each parameter; its standard error, with ``_error`` behind its
            name, infinite where the data cannot tell; ``rms`` of the residuals;
            ``converged`` and ``at_bound``, which are 1 or 0.
        name: What is shown.
    """
    where = window(maps["rms"], PIXELS)
    shown = {key: image[where] for key, image in maps.items()}
    known = {key: p for key, p in parameters(brdf).items() if key in maps}
    rows, columns = shown["rms"].shape[:2]
    height = WIDTH * min(rows / columns, TALLEST)
    lines = len(known) + 1
    figure = new_figure(0.6 + 2 * (WIDTH + 0.9), 0.5 + (height + 0.3) * lines)
    grid = figure.subplots(lines, 2, squeeze=False)
    for (left, right), (key, parameter) in zip(grid, known.items(), strict=False):
        error = shown[f"{key}_error"]
        known_there = np.where(np.isinf(error), np.inf, shown[key])
        _plot_value(left, known_there, key, parameter)
        label = f"standard error{_unit(parameter)}{_of_channels(error)}"
        plot_map(right, error.mean(axis=-1), f"{key}: standard error", label)
    left, right = grid[-1]
    plot_map(left, shown["rms"][..., 0], "residual", "root mean square of a texel")
    _plot_states(right, shown["converged"][..., 0], shown["at_bound"][..., 0])
    entitle(figure, name)
    return figure


def plot_map(
    axes: Axes,
    image: Float[np.ndarray, "row column"],
    title: str,
    label: str,
    logarithmic: bool = False,
) -> None:
    """Numbers in false colours, the infinite in grey; the scale ends where most do."""
    seen = image[np.isfinite(image)]
    low, high = np.percentile(seen, ENDS) if seen.size else (0.0, 1.0)
    if logarithmic and low > 0 and high / low > DECADE:
        norm: Normalize = LogNorm(low, high)
    else:
        norm = Normalize(low, high if high > low else low + max(abs(low), 1) * 1e-3)
    shown = axes.imshow(image, norm=norm, cmap="viridis", interpolation="nearest")
    _finish(axes, title, np.isinf(image))
    beyond = seen.size and (bool(seen.min() < low), bool(seen.max() > norm.vmax))
    extend = {(True, True): "both", (True, False): "min", (False, True): "max"}
    _bar(axes, shown, label, extend.get(beyond or (False, False), "neither"))


def plot_colours(axes: Axes, image: Map, title: str, label: str) -> None:
    """Three channels as colours, with greys that tell the numbers."""
    seen = np.isfinite(image).all(axis=-1)
    top = float(np.percentile(image[seen], ENDS[1])) if seen.any() else 1.0
    top = top if top > 0 else 1.0
    colour = np.dstack([images.preview(image, 1 / top), 255 * seen]).astype(np.uint8)
    axes.imshow(colour, interpolation="nearest")
    _finish(axes, title, np.isinf(image).any(axis=-1))
    greys = np.repeat(np.linspace(0, 1, 256)[:, None, None], RGB, axis=-1)
    scale = ListedColormap(images.preview(greys)[:, 0] / 255)
    greys_of = ScalarMappable(Normalize(0, top), scale)
    beyond = bool(seen.any() and image[seen].max() > top)
    _bar(axes, greys_of, f"{label}, as grey", "max" if beyond else "neither")


def _plot_value(axes: Axes, image: Map, name: str, known: Parameter) -> None:
    """A parameter: in its colours where it has three channels."""
    title, label = f"{name} ${known.symbol}$", f"{name}{_unit(known)}"
    if image.shape[-1] == RGB:
        plot_colours(axes, image, title, label)
    else:
        label += _of_channels(image)
        plot_map(axes, image.mean(axis=-1), title, label, known.logarithmic)


def _plot_states(axes: Axes, converged: np.ndarray, at_bound: np.ndarray) -> None:
    """How the fit of each texel ended, and the share of each ending."""
    seen = np.isfinite(converged)
    state = np.where(converged > 0, np.where(at_bound > 0, 1, 0), 2)
    shown = axes.imshow(
        np.where(seen, state, np.nan),
        cmap=ListedColormap(list(STATES.values())),
        vmin=-0.5,
        vmax=len(STATES) - 0.5,
        interpolation="nearest",
    )
    axes.set_title("end of the fit")
    axes.set_axis_off()
    bar = _bar(axes, shown, "share of the texels", "neither")
    bar.set_ticks(
        range(len(STATES)),
        labels=[
            f"{name}\n{100 * np.mean(state[seen] == number):.2f} %"
            for number, name in enumerate(STATES)
        ],
    )
    bar.ax.tick_params(length=0)


def _finish(axes: Axes, title: str, unknown: Any) -> None:
    """A title, and grey where the data cannot tell."""
    if unknown.any():
        grey = np.where(unknown[..., None], to_rgba(NO_DATA), 0.0)
        axes.imshow(grey, interpolation="nearest")
        title += " (grey: not determined)"
    axes.set_title(title)
    axes.set_axis_off()


def _bar(axes: Axes, shown: Any, label: str, extend: str) -> Colorbar:
    """A scale as high as its panel."""
    bar = axes.figure.colorbar(shown, ax=axes, extend=extend, fraction=0.05, pad=0.03)
    bar.set_label(label, size=8)
    bar.outline.set_linewidth(0.5)
    return bar


def window(image: Map, most: int) -> tuple[slice, slice]:
    """Rows and columns that hold numbers, so many in each direction at most."""
    seen = np.isfinite(image[..., 0])
    parts = []
    for axis in (1, 0):
        places = np.flatnonzero(seen.any(axis=axis))
        first, last = (places[0], places[-1] + 1) if len(places) else (0, 1)
        parts.append(slice(first, last, -(-(last - first) // most)))
    return parts[0], parts[1]


def _unit(known: Parameter) -> str:
    return "" if known.unit == "1" else f" ({known.unit})"


def _of_channels(image: Map) -> str:
    return ", mean of channels" if image.shape[-1] > 1 else ""
