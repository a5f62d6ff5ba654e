"""The Phong shading equation, read as a BRDF."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import mirror, mirror_cosine, mirror_deficit
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class PhongOriginal(AbstractBRDF):
    r"""Phong's shading equation of 1975 divided by the cosine of the incident angle.

    $$f_r = k_d + k_s\,\frac{\max(0, \omega_r\cdot\omega_o)^p}{\cos\theta_i}$$

    with $\omega_r$ the mirror image of $\omega_i$. The weights are those of the shading
    equation $L = k_d I\,(n\cdot\omega_i) + k_s I\,(\omega_r\cdot\omega_o)^p$: $k_d$
    carries no $1/\pi$, so the albedo of the diffuse part is $\pi k_d$. Near the
    mirror direction the power is taken of $1 - |\omega_r - \omega_o|^2/2$, which keeps
    its digits there. The lobe is 0 where $\omega_r\cdot\omega_o \le 0$, for $p = 0$
    too.

    Range:
        $f_r \ge 0$, without bound as $\theta_i$ goes to 90 degrees: not reciprocal, not
        energy conserving. With $k_d = k_s = 0.5$ and $p = 10$ the directional albedo is
        1.83 at normal incidence, 3.55 at 89 degrees and 186 at 89.99 degrees.

    Source:
        B. T. Phong, "Illumination for Computer Generated Pictures", Communications of
        the ACM 18(6), 1975, https://doi.org/10.1145/360825.360839
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

    reciprocal: ClassVar[bool] = False
    energy_conserving: ClassVar[bool] = False

    def lobe_axis(self, wi: Direction) -> Direction:
        return mirror(wi)

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        (xi, yi, zi), (xo, yo, zo) = wi, wo
        cosine, deficit = mirror_cosine(wi, wo), mirror_deficit(wi, wo)
        # one of the powers over the cosine is a quotient that changes little, where
        # the derivatives of the power and of the cosine alone would cancel
        whole = self.exponent >= 1
        quotient = jnp.maximum(zo - (xi * xo + yi * yo) / zi, 0.0)
        rest = numerics.pow_near_one(cosine, deficit, self.exponent - whole)
        lobe = rest * jnp.where(whole, quotient, 1 / zi)
        return self.diffuse + self.specular * lobe
