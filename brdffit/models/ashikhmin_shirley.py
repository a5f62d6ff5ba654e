"""Anisotropic Phong gloss over a base that it shades."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import bisector, larger_cosine
from brdffit.microfacet import fresnel
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class AshikhminShirley(AbstractBRDF):
    r"""Anisotropic Phong lobe with Fresnel reflection over a diffuse base.

    $$f_r = \frac{28 k_d (1 - k_s)}{23\pi}
            \Bigl(1 - \bigl(1 - \tfrac{\cos\theta_i}{2}\bigr)^5\Bigr)
            \Bigl(1 - \bigl(1 - \tfrac{\cos\theta_o}{2}\bigr)^5\Bigr)
            + \frac{\sqrt{(p_u + 1)(p_v + 1)}}{8\pi}\,
            \frac{\cos\theta_h^{\,(p_u h_x^2 + p_v h_y^2)/(1 - \cos^2\theta_h)}}
            {\cos\theta_d\max(\cos\theta_i, \cos\theta_o)}\,F(\cos\theta_d)$$

    with Schlick's $F = k_s + (1 - k_s)(1 - \cos\theta_d)^5$. With the slopes
    $t = (h_x, h_y)/h_z$ the power is
    $\exp\bigl(-\frac12 (p_u t_x^2 + p_v t_y^2)\,\log(1 + t^2)/t^2\bigr)$, whose
    quotient is 1 at $h = n$.

    Range:
        $f_r \ge 0$; directional albedo at most 1 for $k_d \le 1$ and $k_s \le 1$, and
        lost towards grazing: for $k_d = 0$, $k_s = 1$ and $p = 10$ it is 0.70 at normal
        incidence and 0.50 at 89 degrees.

    Source:
        M. Ashikhmin and P. Shirley, "An Anisotropic Phong BRDF Model", Journal of
        Graphics Tools 5(2), 2000, eq. 4-5,
        https://doi.org/10.1080/10867651.2000.10487522
    """

    diffuse: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_d",
        spectral=True,
    )
    specular: Spectrum = parameter(
        0.04,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_s",
        spectral=True,
    )
    exponent_u: Scalar = parameter(
        50.0,
        bounds=(0.0, 1e5),
        typical=(1.0, 2000.0),
        symbol="p_u",
        logarithmic=True,
    )
    exponent_v: Scalar = parameter(
        500.0,
        bounds=(0.0, 1e5),
        typical=(1.0, 2000.0),
        symbol="p_v",
        logarithmic=True,
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True
    isotropic: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        cos_i, cos_o, cos_d = wi[2], wo[2], fresnel.cos_d(wh)
        pu, pv = self.exponent_u, self.exponent_v
        u, v = wh[0] / wh[2], wh[1] / wh[2]
        power = (pu * u * u + pv * v * v) * numerics.log1p_ratio(u * u + v * v)
        peak = numerics.sqrt(pu + 1) * numerics.sqrt(pv + 1) / (8 * jnp.pi)
        gloss = peak * jnp.exp(-0.5 * power) / cos_d / larger_cosine(wi, wo)
        base = 28 / (23 * jnp.pi) * bend(cos_i) * bend(cos_o)
        return self.diffuse * (1 - self.specular) * base + gloss * fresnel.schlick(
            cos_d, self.specular
        )


def bend(cos_theta: Scalar) -> Scalar:
    """``1 - (1 - cos_theta / 2)^5``, multiplied out to keep its digits."""
    x = cos_theta / 2
    return x * (5 + x * (-10 + x * (10 + x * (-5 + x))))
