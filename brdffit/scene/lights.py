"""Lights: from where, and how much of it."""

from functools import partial

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

    direction: Float[np.ndarray, "3"] = eqx.field(
        converter=partial(values.unit_vector, "direction")
    )
    irradiance: Float[np.ndarray, "..."] = eqx.field(
        default=1.0, converter=partial(values.spectrum, "irradiance")
    )
