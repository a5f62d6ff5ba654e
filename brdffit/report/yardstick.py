"""Errors in words: a root mean square of some residual as a percentage."""

import dataclasses
import math

import jax.numpy as jnp
import numpy as np

from brdffit.fit import RESIDUALS
from brdffit.fit.blocks import usable
from brdffit.fit.residual import Residual
from brdffit.names import look_up
from brdffit.samples import Samples

LEAST = 0.001  # percent below which an error is that of rounding
RELATIVE = ("log", "log_relative")  # residuals whose differences are relative errors


@dataclasses.dataclass(frozen=True)
class Yardstick:
    """What makes a percentage of a root mean square.

    Attributes:
        residual: The residual that the errors are under.
        scale: Root mean square of the measured quantity under it.
    """

    residual: Residual
    scale: float

    @property
    def relative(self) -> bool:
        """Whether the residual is a logarithm, whose differences are relative."""
        return self.residual.name in RELATIVE

    def percent(self, rms: float) -> str:
        """An error in percent: of each value under a logarithm, else of the scale."""
        share = math.expm1(min(rms, 20)) if self.relative else rms / self.scale
        share *= 100
        if not math.isfinite(share):
            return "unknown"
        if share < LEAST:
            return f"<\N{NARROW NO-BREAK SPACE}{LEAST}\N{NO-BREAK SPACE}%"
        shown = f"{share:#.2g}".rstrip(".") if share < 99.5 else f"{share:.0f}"
        return f"{shown}\N{NO-BREAK SPACE}%"

    @property
    def meaning(self) -> str:
        """What such a percentage says."""
        if self.relative:
            return "typical relative error of a value"
        return "root mean square, relative to that of the data"


def yardstick(name: str, samples: Samples) -> Yardstick:
    """The yardstick of errors under a residual on these data.

    Raises:
        ValueError: There is no such residual.
    """
    residual = look_up(RESIDUALS, name, "Residual")
    use = usable(samples, residual)
    measured = np.where(use, np.asarray(samples.value), 1.0)
    compared = np.asarray(residual.on(samples)(jnp.asarray(measured)))[use]
    scale = float(np.sqrt(np.mean(compared**2))) if compared.size else math.nan
    return Yardstick(residual, scale or math.nan)
