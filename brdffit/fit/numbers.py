"""The numbers of a fit one by one, each as far as its error lets it be known."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from brdffit.fit.result import FitResult
from brdffit.parameters import Parameter, parameters
from brdffit.per_channel import PerChannel

LOST = "undetermined"
DIGITS = 6  # most significant digits of a value


class Row(NamedTuple):
    """One number of a fit."""

    label: str
    channel: str
    value: float
    error: float
    unit: str
    bounds: str
    note: str

    @property
    def title(self) -> str:
        """Label, with the name of the channel when there are several."""
        return f"{self.label} {self.channel}".strip()


def rows(result: FitResult) -> Iterator[Row]:
    """One row for each number of a fit, in the order of the correlation matrix."""
    known = known_parameters(result)
    labels = iter(result.labels)
    several = len(result.channels) > 1
    for name, value in result.parameters.items():
        errors = np.atleast_1d(result.standard_errors[name])
        spectral = np.ndim(value) > 0
        for place, number in enumerate(np.atleast_1d(value)):
            label, error = next(labels), float(errors[place])
            note = ""
            if label in result.at_bound:
                note = "at bound"
            elif label in result.undetermined:
                note = LOST
            elif error == 0:
                note = "held"
            channel = result.channels[place] if spectral and several else ""
            unit = known[name].unit
            bounds = f"[{known[name].lower:g}, {known[name].upper:g}]"
            yield Row(label, channel, float(number), error, unit, bounds, note)


def known_parameters(result: FitResult) -> dict[str, Parameter]:
    """What is declared of each parameter of a fit, by its name."""
    brdf = result.brdf
    return parameters(brdf.parts[0] if isinstance(brdf, PerChannel) else brdf)


def rounded(value: float, error: float) -> tuple[str, str]:
    """A value and its error, to two digits of the error; the error "" when it has none.

    An infinite error leaves three digits of the value, a very small one six.
    """
    if not math.isfinite(error):
        return f"{value:.3g}", LOST
    if error <= 0:
        return f"{value:.{DIGITS}g}", ""
    size = math.floor(math.log10(abs(value) or error))
    decimals = 1 - math.floor(math.log10(error))
    if not -4 <= size < DIGITS or decimals - 1 + size >= DIGITS:
        return f"{value:.{DIGITS}g}", f"{error:.2g}"
    places = max(decimals, 0)
    return (
        f"{round(value, decimals):.{places}f}",
        f"{round(error, decimals):.{places}f}",
    )
