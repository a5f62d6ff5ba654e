"""Goniometers: which pairs of directions an instrument measures."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from brdffit.geometry import direction
from brdffit.scene import values
from brdffit.types import Vectors

Degrees = Float[np.ndarray, " angle"]


class Goniometer(eqx.Module):
    """All combinations of three lists of angles, in degrees.

    The light stands at azimuth 0. So ``phi`` 0 and 180 make the plane of incidence,
    with the mirror direction at 180; every other ``phi`` leads out of it.

    Attributes:
        theta_i: Polar angles of the light, from 0 to below 90.
        theta_o: Polar angles of the viewer, from 0 to below 90.
        phi: Azimuths of the viewer.

    Raises:
        ValueError: A list is empty or not of numbers, or a polar angle out of range.
    """

    theta_i: Degrees = eqx.field(converter=partial(values.polar_angles, "theta_i"))
    theta_o: Degrees = eqx.field(converter=partial(values.polar_angles, "theta_o"))
    phi: Degrees = eqx.field(converter=partial(values.angles, "phi"))

    def directions(self) -> tuple[Vectors, Vectors]:
        """Unit vectors ``wi`` and ``wo``; ``phi`` changes fastest, ``theta_i`` last."""
        grid = np.meshgrid(self.theta_i, self.theta_o, self.phi, indexing="ij")
        with jax.enable_x64(True):
            theta_i, theta_o, phi = (jnp.radians(angle.ravel()) for angle in grid)
            wi = np.asarray(jax.vmap(direction)(theta_i, jnp.zeros_like(phi)))
            wo = np.asarray(jax.vmap(direction)(theta_o, phi))
        return wi.astype(np.float32), wo.astype(np.float32)
