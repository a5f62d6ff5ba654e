"""Rough diffuse reflection that loses no energy."""

import math
from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum

C1 = 1 / 2 - 2 / (3 * math.pi)
C2 = 2 / 3 - 28 / (15 * math.pi)


class Eon(AbstractBRDF):
    r"""Energy-preserving Oren-Nayar: a rough diffuse surface with all interreflection.

    $$f_r = \frac{\rho}{\pi}\,\frac{1 + r\,s/t}{1 + c_1 r} + \frac{\rho_{ms}}{\pi}\,
            \frac{(1 - E(\omega_i))(1 - E(\omega_o))}{1 - \bar E}, \qquad
      \rho_{ms} = \frac{\rho^2 \bar E}{1 - \rho\,(1 - \bar E)}$$

    with $s = x_i x_o + y_i y_o$, $t = \max(\cos\theta_i, \cos\theta_o)$ where $s > 0$
    and 1 elsewhere, $c_1 = \frac12 - \frac{2}{3\pi}$,
    $c_2 = \frac23 - \frac{28}{15\pi}$, $A = 1/(1 + c_1 r)$, $\bar E = A(1 + c_2 r)$ and

    $$E = A\,\Bigl(1 + \frac r\pi G\Bigr), \qquad
      G = \sin\theta\,(\theta - \sin\theta\cos\theta)
        + \tfrac23\Bigl(\tfrac{\sin\theta}{\cos\theta}(1 - \sin^3\theta)
        - \sin\theta\Bigr)$$

    The first term is single scattering, the second gives back what it loses. In the
    code $1 - E = A\,r\,(c_1 - G/\pi)$, so that the second term needs no quotient of
    vanishing numbers at $r = 0$, at grazing, or at the normal.

    Range:
        $f_r \ge 0$; equals Lambert at $r = 0$. The directional albedo is exactly 1 at
        every angle when $\rho = 1$; for $\rho = 0.5$, $r = 1$ it rises from 0.44 at
        normal incidence to 0.50 at grazing. $r$ lies in [0, 1] and is not the $\sigma$
        of `oren_nayar`.

    Source:
        J. Portsmouth, P. Kutz and S. Hill, "EON: A Practical Energy-Preserving Rough
        Diffuse BRDF", 2024, https://arxiv.org/abs/2410.18026, with the exact $E$.
    """

    albedo: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol=r"\rho",
        spectral=True,
    )
    roughness: Scalar = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.0, 1.0),
        symbol="r",
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        (xi, yi, cos_i), (xo, yo, cos_o) = wi, wo
        rho, r = self.albedo, self.roughness
        a = 1 / (1 + C1 * r)
        s = xi * xo + yi * yo
        back = 1 + r * s / jnp.maximum(cos_i, cos_o)
        # 1 + s without its cancellation, for directions that graze opposite each other
        x, y = xi + xo, yi + yo
        apart = 0.5 * (x * x + y * y + cos_i * cos_i + cos_o * cos_o)
        single = a * jnp.where(s > 0, back, (1 - r) + r * apart)
        average = a * (1 + C2 * r)
        lost = a * r / (C1 - C2) * deficit(wi) * deficit(wo)
        multiple = rho * rho * average / (1 - rho * (1 - average))
        return (rho * single + multiple * lost) / jnp.pi


def deficit(w: Direction) -> Scalar:
    """``c_1 - G / pi``, the energy that single scattering loses, over ``A r``."""
    x, y, mu = w
    s = numerics.norm_of(x, y)
    angle = mu * numerics.angle_ratio(mu, s)
    turn = (jnp.pi / 2 - 2 / 3) * mu * mu - 2 / 3 * s * mu * (1 + s + s * s)
    return (turn / (1 + s) + s * angle + s * s * mu) / jnp.pi
