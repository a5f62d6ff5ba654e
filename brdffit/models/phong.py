"""A diffuse base and a lobe about the mirror direction."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import mirror, mirror_cosine, mirror_deficit
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class Phong(AbstractBRDF):
    r"""Modified Phong model: reciprocal, and normalised so that it conserves energy.

    $$f_r = \frac{k_d}{\pi} + k_s\,\frac{p + 2}{2\pi}\,
            \max(0, \omega_r\cdot\omega_o)^p$$

    with $\omega_r$ the mirror image of $\omega_i$. Near the mirror direction the power
    is taken of $1 - |\omega_r - \omega_o|^2/2$, which keeps its digits there. The lobe
    is 0 where $\omega_r\cdot\omega_o \le 0$, for $p = 0$ too.

    Range:
        $f_r \ge 0$; directional albedo at most $k_d + k_s$, reached at normal
        incidence. The lobe darkens towards grazing, where half of it is lost below the
        horizon: for $p = 10$ its albedo is 0.50 at 60 degrees and 0.13 at 89 degrees.

    Source:
        E. Lafortune and Y. Willems, "Using the Modified Phong Reflectance Model for
        Physically Based Rendering", Report CW 197, KU Leuven, 1994.
    """

    diffuse: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_d",
        spectral=True,
        linear=True,
    )
    specular: Spectrum = parameter(
        0.3,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_s",
        spectral=True,
        linear=True,
    )
    exponent: Scalar = parameter(
        50.0,
        bounds=(0.0, 1e5),
        typical=(1.0, 2000.0),
        symbol="p",
        logarithmic=True,
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True

    def lobe_axis(self, wi: Direction) -> Direction:
        return mirror(wi)

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        cosine, deficit = mirror_cosine(wi, wo), mirror_deficit(wi, wo)
        lobe = numerics.pow_near_one(cosine, deficit, self.exponent)
        peak = (self.exponent + 2) / (2 * jnp.pi)
        return self.diffuse / jnp.pi + self.specular * (peak * lobe)
