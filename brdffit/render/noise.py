"""Noise of a simulated measurement: stated, seeded, and known for every sample."""

from functools import partial

import equinox as eqx
import numpy as np

from brdffit.scene import values
from brdffit.types import Values


class Noise(eqx.Module):
    """Independent normal errors of every sample and channel.

    The standard deviation is ``sqrt((relative value)^2 + additive^2)``. Values that
    fall below zero are kept, because cutting them off would raise the mean.

    Attributes:
        relative: Standard deviation as a share of the true value.
        additive: Standard deviation in the unit of the values.
        seed: Of numpy's default generator; the same seed gives the same noise.

    Raises:
        ValueError: A standard deviation or the seed is negative or not a number.
    """

    relative: float = eqx.field(
        default=0.0, converter=partial(values.not_negative, "relative")
    )
    additive: float = eqx.field(
        default=0.0, converter=partial(values.not_negative, "additive")
    )
    seed: int = eqx.field(default=0, converter=partial(values.whole, "seed", least=0))

    def __call__(self, truth: Values) -> tuple[Values, Values | None]:
        """``truth`` with noise, and its standard deviation; None without any noise."""
        truth = np.asarray(truth)
        if self.relative == self.additive == 0:
            return truth, None
        sigma = np.hypot(self.relative * np.float64(truth), self.additive)
        error = sigma * np.random.default_rng(self.seed).standard_normal(truth.shape)
        return (truth + error).astype(truth.dtype), sigma.astype(truth.dtype)


NOISELESS = Noise()
