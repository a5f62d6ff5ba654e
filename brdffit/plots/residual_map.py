"""Residual map: where in the angles of half vector and difference a fit is off."""

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from brdffit.plots.plane import polar
from brdffit.plots.style import DIVERGING
from brdffit.samples import Samples
from brdffit.types import Values

CELLS = 22  # across the map
HALF = r"$\theta_h$ [degrees]"
DIFFERENCE = r"$\theta_d$ [degrees]"


def plot_residual_map(
    axes: Axes,
    half: Float[np.ndarray, " sample"],
    difference: Float[np.ndarray, " sample"],
    error: Values,
    limit: float,
) -> PolyCollection:
    """Draw the mean error in cells of both angles, white at zero.

    Args:
        axes: Where to draw.
        half: Angle between half vector and normal of each sample in degrees.
        difference: Angle between light and half vector in degrees.
        error: Error of each value, NaN where there is none.
        limit: Value at both ends of the colour scale.
    """
    here = np.isfinite(error)
    x, y = (np.broadcast_to(a[:, None], error.shape)[here] for a in (half, difference))
    cells = axes.hexbin(
        x,
        y,
        C=error[here],
        gridsize=CELLS,
        extent=(0, 90, 0, 90),
        cmap=DIVERGING,
        vmin=-limit,
        vmax=limit,
        linewidths=0.2,
    )
    axes.set(xlim=(0, 90), ylim=(0, 90), xlabel=HALF, ylabel=DIFFERENCE)
    axes.set_xticks(range(0, 91, 30))
    axes.set_yticks(range(0, 91, 30))
    return cells


def half_and_difference(samples: Samples) -> tuple[np.ndarray, np.ndarray]:
    """Both angles of each sample in degrees, to the light that can add most."""
    brightest = np.asarray(samples.weight).sum(axis=2).argmax(axis=1)
    wi = np.asarray(samples.wi, float)[np.arange(len(samples)), brightest]
    wo = np.asarray(samples.wo, float)
    cosine = np.clip(np.sum(wi * wo, axis=1), -1, 1)
    return polar(wi + wo)[0], np.degrees(np.arccos(cosine)) / 2
