"""A photograph that no fit has seen, beside what the fitted texture shows there."""

import numpy as np
from matplotlib.figure import Figure

from brdffit.plots.maps import PIXELS, WIDTH, Map, window
from brdffit.plots.spheres import plot_difference, plot_sphere
from brdffit.plots.style import entitle, new_figure, styled

BRIGHT = 99.5  # percentile that is shown just unclipped
LARGEST = 99  # percentile of the differences at which the colour scale ends


@styled
def relit_figure(photograph: Map, predicted: Map, name: str) -> Figure:
    """Photograph, prediction under the same light, and the difference.

    Args:
        photograph: Radiance; NaN where there is no texel or nothing can be compared.
        predicted: Radiance; NaN where there is no texel.
        name: What is shown, and how well it is predicted.
    """
    where = window(predicted, PIXELS)
    photograph, predicted = photograph[where], predicted[where]
    rows, columns = predicted.shape[:2]
    difference = predicted - photograph
    mean = np.abs(difference.mean(axis=-1))
    limit = float(np.nanpercentile(mean, LARGEST)) or 1.0
    exposure = 1 / float(np.nanpercentile(photograph, BRIGHT))
    figure = new_figure(3 * WIDTH + 1.0, 0.8 + WIDTH * rows / columns)
    left, middle, right = figure.subplots(1, 3)
    whole = np.isfinite(photograph).all(axis=-1, keepdims=True)
    plot_sphere(left, np.where(whole, photograph, np.nan), exposure)
    left.set_title("photograph, held out")
    plot_sphere(middle, predicted, exposure)
    middle.set_title("predicted")
    unused = np.isnan(difference) & np.isfinite(predicted)
    shown = plot_difference(right, difference, limit, unused.astype(float))
    right.set_title(
        "predicted - photograph" + " (grey: not compared)" * bool(unused.any())
    )
    bar = figure.colorbar(shown, ax=right, extend="both", fraction=0.05, pad=0.03)
    bar.set_label("radiance, mean of channels", size=8)
    figure.supxlabel(f"pictures: sRGB, exposure x {exposure:.3g}", size=8)
    entitle(figure, name)
    return figure
