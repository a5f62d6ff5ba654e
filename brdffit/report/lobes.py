"""Lobes of a report as numbers, which the page draws."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from brdffit.models import AbstractBRDF
from brdffit.plots.lobe import predicted
from brdffit.plots.plane import planes
from brdffit.plots.style import spread
from brdffit.report.formulas import as_html
from brdffit.samples import Measurement, Samples, as_samples

PLANES = 8  # most angles of incidence
CHANNELS = 3  # most channels
POINTS = 300  # most samples of a plane
DIGITS = 4  # significant digits of a value


def lobe_table(
    data: Measurement | Samples, models: Mapping[str, AbstractBRDF]
) -> dict[str, Any] | None:
    """Measured and fitted reflectance in each plane, in types that JSON knows.

    Args:
        data: What was fitted.
        models: Fitted models by name, the best first.

    Returns:
        Names of ``channels`` and a list of ``planes``; each has the values of every
        channel, measured at ``angle`` and of every model along ``curve``, in degrees
        and 1/sr. None where the data have no plane under a single light.
    """
    found = spread(planes(data), PLANES)
    if not found:
        return None
    names = as_samples(data).channels
    shown = spread(range(len(names)), CHANNELS)
    tables = []
    for plane in found:
        used = np.flatnonzero(np.isfinite(plane.f_r[:, shown]).any(axis=1))
        drawn = spread(used.tolist(), POINTS)
        tables.append(
            {
                "title": as_html(plane.title),
                "label": as_html(plane.label),
                "mirror": plane.mirror,
                "angle": numbers(plane.angle[drawn]),
                "measured": [numbers(plane.f_r[drawn, channel]) for channel in shown],
                "curve": numbers(plane.curve),
                "models": {
                    name: [numbers(value) for value in predicted(brdf, plane).T[shown]]
                    for name, brdf in models.items()
                },
            }
        )
    return {"channels": [names[channel] for channel in shown], "planes": tables}


def numbers(values: np.ndarray) -> list[float | None]:
    """Values to a few digits; None where there is none, which JSON has a word for."""
    return [
        float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None for value in values
    ]
