"""Thumbnails: a fit at a glance, as a sphere and as a lobe over what was measured."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from brdffit.fit import FitResult
from brdffit.models import AbstractBRDF
from brdffit.plots.lobe import plot_lobe
from brdffit.plots.plane import planes
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import styled
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.samples import Measurement, Samples
from brdffit.scene import lit_sphere

HEIGHT = 1.0  # inches
MARGIN = 1.5  # times what was measured that the lobe shows
LOBE = 1.6  # inches, width of the lobe
RESOLUTION = 128  # of the sphere
BRIGHT = 0.8  # linear value of the pixel than which one in a hundred is brighter


@styled
def thumbnail_figure(data: Measurement | Samples, result: FitResult) -> Figure:
    """A sphere rendered with the fit and the lobe of one plane, without any words.

    The lobe, logarithmic and of the middle channel, is left out of data that have no
    plane under a single light.
    """
    found = planes(data)
    width = HEIGHT + (LOBE if found else 0)
    figure = Figure((width, HEIGHT))
    sphere = figure.add_axes((0.02 / width, 0.02, 0.96 * HEIGHT / width, 0.96))
    _sphere(sphere, result.brdf)
    if found:
        lobe = figure.add_axes((HEIGHT / width, 0.04, (LOBE - 0.04) / width, 0.92))
        plane, channel = found[len(found) // 2], result.brdf.channels // 2
        plot_lobe(lobe, plane, {"": result.brdf}, channel, logarithmic=True)
        measured = plane.f_r[:, channel]
        seen = measured[measured > 0]  # where a model may go far beyond is not
        if seen.size:
            lobe.set_ylim(seen.min() / MARGIN, seen.max() * MARGIN)
        lobe.set(xlabel="", ylabel="", xticks=[], yticks=[])
        lobe.minorticks_off()
    return figure


def _sphere(axes: Axes, brdf: AbstractBRDF) -> None:
    """A sphere under one light from the upper left, exposed for itself."""
    samples = trace(lit_sphere(RESOLUTION), channels=brdf.channels)
    assert samples.pixels is not None  # for the type checker
    value = np.asarray(compiled_shade(brdf, samples))
    lit = value[value > 0]
    exposure = BRIGHT / float(np.percentile(lit, 99)) if lit.size else 1.0
    plot_sphere(axes, samples.pixels.images(value)[0], exposure)
