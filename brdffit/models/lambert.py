"""Ideal diffuse reflection."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Spectrum


class Lambert(AbstractBRDF):
    r"""Ideal diffuse reflection.

    $$f_r = \frac{\rho}{\pi}$$

    Range:
        $0 \le f_r \le 1/\pi$; directional albedo is exactly $\rho$.

    Source:
        J. H. Lambert, *Photometria*, 1760.
    """

    albedo: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol=r"\rho",
        spectral=True,
        linear=True,
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        del wi, wo
        return self.albedo / jnp.pi
