"""Spheres: what was photographed beside what the fits show, and the difference.

A measurement without pixels is shown as spheres rendered with the fitted models.
"""

from collections.abc import Iterable, Mapping

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from brdffit import images
from brdffit.fit import FitResult
from brdffit.models import AbstractBRDF
from brdffit.plots.style import DIVERGING, NO_DATA, entitle, new_figure, spread, styled
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.samples import Measurement, Samples
from brdffit.scene import lit_sphere
from brdffit.types import Image, Values

MODELS = 4  # most models side by side
FRAMES = 2  # most photographs one above the other
RESOLUTION = 256  # of rendered spheres
BRIGHT = 0.8  # linear value at which the brightest percent of the pixels begins
LARGEST = 99.5  # percentile of the differences at which the colour scale ends


@styled
def spheres_figure(
    data: Measurement | Samples, results: Mapping[str, FitResult]
) -> Figure:
    """Measured and fitted spheres with their difference, or only rendered ones.

    Args:
        data: What was fitted.
        results: Fits by the name to show, the best first; four are shown.
    """
    shown = {name: result.brdf for name, result in list(results.items())[:MODELS]}
    best = (
        f", the best {MODELS} of {len(results)} models" if len(results) > MODELS else ""
    )
    if isinstance(data, Samples) and data.pixels is not None:
        figure = _differences(data, shown)
        entitle(figure, f"{data.name}: measured and fitted spheres{best}")
    else:
        figure = _rendered(shown)
        entitle(figure, f"{data.name}: spheres rendered with the fits{best}")
    return figure


def plot_sphere(axes: Axes, image: Image, exposure: float = 1.0) -> None:
    """Show linear pixels as on a screen; pixels that are NaN stay empty."""
    axes.imshow(on_screen(image, exposure), interpolation="antialiased")
    axes.set_axis_off()


def on_screen(image: Image, exposure: float) -> UInt8[np.ndarray, "row column 4"]:
    """Linear pixels in sRGB with opacity, which is 0 where they are NaN."""
    seen = np.isfinite(image).any(axis=-1)
    shown = np.dstack([images.preview(image, exposure), np.where(seen, 255, 0)])
    return shown.astype(np.uint8)


def plot_difference(
    axes: Axes, difference: Image, limit: float, unused: Image | None = None
) -> AxesImage:
    """Show the mean of the channels, white at zero; NaN is empty, unused pixels grey.

    Args:
        axes: Where to draw.
        difference: Fitted minus measured values.
        limit: Value at both ends of the colour scale.
        unused: Above 0 where a pixel was not used, NaN or 0 elsewhere.
    """
    if unused is not None:
        covered = np.any(unused > 0, axis=-1)[..., None]
        axes.imshow(np.where(covered, to_rgba(NO_DATA), 0.0), interpolation="nearest")
    axes.set_axis_off()
    return axes.imshow(
        difference.mean(axis=-1),
        cmap=DIVERGING,
        vmin=-limit,
        vmax=limit,
        interpolation="nearest",
    )


def _rendered(models: Mapping[str, AbstractBRDF]) -> Figure:
    """A row of spheres under one light from the upper left."""
    samples = trace(
        lit_sphere(RESOLUTION), channels=next(iter(models.values())).channels
    )
    assert samples.pixels is not None  # for the type checker
    values = {n: np.asarray(compiled_shade(b, samples)) for n, b in models.items()}
    exposure = exposure_of(np.concatenate(list(values.values())))
    figure = new_figure(0.4 + 2.3 * max(len(values), 2), 2.9)
    row = figure.subplots(1, len(values), squeeze=False)[0]
    for axes, (name, value) in zip(row, values.items(), strict=True):
        plot_sphere(axes, samples.pixels.images(value)[0], exposure)
        axes.set_title(name)
    figure.supxlabel(
        f"one light from the upper left; sRGB, exposure x {exposure:.3g}", size=8
    )
    return figure


def _differences(samples: Samples, models: Mapping[str, AbstractBRDF]) -> Figure:
    """Photographs beside fits; below each fit, where it is too bright or too dark."""
    assert samples.pixels is not None  # for the type checker
    frames = spread(range(samples.pixels.shape[0]), FRAMES)
    shown = np.isin(samples.pixels.frame, frames)
    samples, frame_of = samples.take(shown), np.asarray(samples.pixels.frame)[shown]
    measured = np.asarray(samples.value)
    used = np.isfinite(measured)
    if samples.mask is not None:
        used &= np.asarray(samples.mask)
    fitted = {n: np.asarray(compiled_shade(b, samples)) for n, b in models.items()}
    difference = {n: np.where(used, v - measured, np.nan) for n, v in fitted.items()}
    limit = limit_of(difference.values())

    rows, columns = 2 * len(frames), 1 + len(models)
    figure = new_figure(0.9 + 1.9 * columns, 0.5 + 2.0 * rows)
    grid = figure.subplots(rows, columns, squeeze=False)
    pictures = []
    for number, frame in enumerate(frames):
        above, below = grid[2 * number], grid[2 * number + 1]
        here = (frame_of == frame)[:, None]
        exposure = exposure_of(measured[used & here])
        plot_sphere(above[0], frame_image(samples, measured, frame), exposure)
        above[0].set_title("measured" + f", light {frame + 1}" * (len(frames) > 1))
        _explain(below[0], exposure, bool((~used).any()))
        unused = frame_image(samples, (~used).astype(float), frame)
        for axes, under, name in zip(above[1:], below[1:], models, strict=True):
            plot_sphere(axes, frame_image(samples, fitted[name], frame), exposure)
            axes.set_title(name)
            error = frame_image(samples, difference[name], frame)
            pictures.append(plot_difference(under, error, limit, unused))
    bar = figure.colorbar(pictures[0], ax=grid[:, -1], extend="both", shrink=0.7)
    bar.set_label("fitted - measured")
    return figure


def _explain(axes: Axes, exposure: float, unused: bool) -> None:
    """What the rows show, in the place below the measured sphere."""
    words = [
        "above: sRGB,",
        f"exposure x {exposure:.3g}",
        "",
        "right: fitted - measured,",
        "mean of the channels",
        "(grey: not used)" if unused else "",
    ]
    axes.set_axis_off()
    axes.text(
        0.5, 0.5, "\n".join(words), size=8, ha="center", va="center", linespacing=1.4
    )


def limit_of(differences: Iterable[Values]) -> float:
    """End of the colour scale: that which suits the middle one of the models."""
    ends = [np.nanpercentile(np.abs(d.mean(axis=1)), LARGEST) for d in differences]
    return float(np.median(ends)) or 1.0


def frame_image(samples: Samples, values: Values, frame: int) -> Image:
    """One frame, cut to the rows and columns that hold samples; NaN where none is."""
    assert samples.pixels is not None  # for the type checker
    where = samples.pixels
    top, left = where.row.min(), where.column.min()
    shape = where.row.max() - top + 1, where.column.max() - left + 1, values.shape[1]
    canvas = np.full(shape, np.nan)
    here = np.asarray(where.frame) == frame
    canvas[where.row[here] - top, where.column[here] - left] = values[here]
    return canvas


def exposure_of(values: Float[np.ndarray, "..."]) -> float:
    """Factor that shows all but the brightest percent of the lit pixels unclipped."""
    return BRIGHT / float(np.percentile(values[values > 0], 99))
