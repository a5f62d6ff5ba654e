"""Lights: from where, and how much of it."""

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit.scene import values


class Directional(eqx.Module):
    """A light so far away that it comes from one direction everywhere.

    Attributes:
        direction: Unit vector towards the light, in the frame of the world.
        irradiance: What falls on a surface that faces the light: a number for all
            channels, or one for each.

    Raises:
        ValueError: The direction is not a unit vector within 0.001, or the irradiance
            is negative.
    """

    direction: Float[np.ndarray, "3"]
    irradiance: Float[np.ndarray, "..."] = eqx.field(default=1.0)

    def __post_init__(self) -> None:
        """Check the values and restore the unit length of the direction."""
        self.direction = values.unit_vector("direction", self.direction)
        self.irradiance = values.spectrum("irradiance", self.irradiance)
