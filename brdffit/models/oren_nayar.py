"""Rough diffuse reflection."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class OrenNayar(AbstractBRDF):
    r"""Rough diffuse reflection from Lambertian V-cavities, qualitative model.

    $$f_r = \frac{\rho}{\pi}\,\bigl(A + B\,\max(0,\cos(\phi_i-\phi_o))
            \,\sin\alpha\,\tan\beta\bigr)$$

    $$A = 1 - \frac{\sigma^2}{2\,(\sigma^2 + 0.33)}, \qquad
      B = \frac{0.45\,\sigma^2}{\sigma^2 + 0.09}$$

    with $\alpha = \max(\theta_i, \theta_o)$ and $\beta = \min(\theta_i, \theta_o)$.
    The trigonometry is evaluated without angles: with $d = x_i x_o + y_i y_o$ it is
    $\max(0, d) / \max(\cos\theta_i, \cos\theta_o)$.

    Range:
        $f_r \ge 0$; equals Lambert at $\sigma = 0$. With $\rho = 1$ the directional
        albedo exceeds 1 towards grazing, by up to 1.52 % at $\sigma = 0.20$.

    Source:
        M. Oren and S. K. Nayar, "Generalization of Lambert's Reflectance Model",
        SIGGRAPH 1994, the qualitative model, https://doi.org/10.1145/192161.192213
    """

    albedo: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol=r"\rho",
        spectral=True,
        linear=True,
    )
    sigma: Scalar = parameter(
        0.3,
        bounds=(0.0, 1.5707963),
        typical=(0.0, 1.0),
        symbol=r"\sigma",
        unit="rad",
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        (xi, yi, cos_i), (xo, yo, cos_o) = wi, wo
        variance = self.sigma * self.sigma
        a = 1 - 0.5 * variance / (variance + 0.33)
        b = 0.45 * variance / (variance + 0.09)
        azimuthal = jnp.maximum(xi * xo + yi * yo, 0.0) / jnp.maximum(cos_i, cos_o)
        return self.albedo / jnp.pi * (a + b * azimuthal)
