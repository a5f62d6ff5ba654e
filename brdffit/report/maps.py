"""Residual maps of a report: where each fit is off, a small figure for each angle."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from brdffit.fit.misfit import misfit
from brdffit.fit.residual import Residual
from brdffit.models import AbstractBRDF
from brdffit.plots.residual_map import half_and_difference, plot_residual_map
from brdffit.plots.residuals import LARGEST, POINTS, plot_residuals, sample_angles
from brdffit.plots.style import new_figure, styled
from brdffit.report.embed import embed_figure
from brdffit.samples import Samples

SIZE = (3.2, 2.7)  # inches
NAMES = ("the light", "the viewer", "the half vector")  # of the angles to the normal


class Panel(NamedTuple):
    """A small figure.

    Attributes:
        uri: The picture.
        alt: What it shows, in words.
    """

    uri: str
    alt: str


class Maps(NamedTuple):
    """Residual maps of all models.

    Attributes:
        panels: Figures by the name of the model.
        values: Number of values that were used.
        drawn: Number of values drawn in a panel.
    """

    panels: dict[str, list[Panel]]
    values: int
    drawn: int


@styled
def residual_maps(
    samples: Samples, models: Mapping[str, AbstractBRDF], residual: Residual
) -> Maps:
    """Residual of every value against three angles, and in the plane of two.

    Args:
        samples: What was fitted.
        models: Fitted models by name, the best first.
        residual: What was minimised.
    """
    errors = {name: misfit(brdf, samples, residual) for name, brdf in models.items()}
    angles = dict(zip(NAMES, sample_angles(samples).items(), strict=True))
    both = half_and_difference(samples)
    panels = {}
    for name, error in errors.items():
        drawn = []
        limit = float(np.nanpercentile(np.abs(error), LARGEST)) or 1.0
        for whose, (label, angle) in angles.items():
            figure = new_figure(*SIZE)
            axes = figure.subplots()
            plot_residuals(axes, angle, error, limit)
            axes.set_xlabel(label)
            axes.set_ylabel("fitted \N{MINUS SIGN} measured")
            low, high = _trend(angle, error)
            alt = (
                f"Residual of {name} against the angle of {whose}: median {low:+.2g} "
                f"at small angles, {high:+.2g} at large ones."
            )
            drawn.append(Panel(embed_figure(figure), alt))
        figure = new_figure(*SIZE)
        axes = figure.subplots()
        cells = plot_residual_map(axes, *both, error, limit)
        figure.colorbar(cells, label="fitted \N{MINUS SIGN} measured")
        alt = f"Mean residual of {name} over half and difference angle, in colours."
        drawn.append(Panel(embed_figure(figure), alt))
        panels[name] = drawn
    used = int(np.isfinite(next(iter(errors.values()))).sum())
    return Maps(panels, used, min(used, POINTS))


def _trend(angle: np.ndarray, error: np.ndarray) -> tuple[float, float]:
    """Median error in the first third of the angles and in the last."""
    here = np.isfinite(error)
    x, y = np.broadcast_to(angle[:, None], error.shape)[here], error[here]
    low, high = np.quantile(x, (1 / 3, 2 / 3))
    return float(np.median(y[x <= low])), float(np.median(y[x >= high]))
