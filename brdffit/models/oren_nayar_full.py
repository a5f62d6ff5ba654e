"""Rough diffuse reflection with one interreflection."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class OrenNayarFull(AbstractBRDF):
    r"""Rough diffuse reflection from Lambertian V-cavities, the full model of 1994.

    $$f_r = \frac{\rho}{\pi}\Bigl[C_1 + \cos\phi\,C_2\tan\beta
            + (1 - |\cos\phi|)\,C_3\tan\frac{\alpha + \beta}{2}\Bigr]
            + \frac{0.17\,\rho^2}{\pi}\frac{\sigma^2}{\sigma^2 + 0.13}
            \Bigl[1 - \cos\phi\,\bigl(\tfrac{2\beta}{\pi}\bigr)^2\Bigr]$$

    $$C_1 = 1 - \frac{\sigma^2}{2\,(\sigma^2 + 0.33)}, \qquad
      C_2 = \frac{0.45\,\sigma^2}{\sigma^2 + 0.09}\Bigl(\sin\alpha
            - [\cos\phi < 0]\bigl(\tfrac{2\beta}{\pi}\bigr)^3\Bigr), \qquad
      C_3 = \frac{0.125\,\sigma^2}{\sigma^2 + 0.09}
            \Bigl(\frac{4\alpha\beta}{\pi^2}\Bigr)^2$$

    with $\alpha = \max(\theta_i, \theta_o)$, $\beta = \min(\theta_i, \theta_o)$ and
    $\phi = \phi_i - \phi_o$. In the code $\tan\frac{\alpha + \beta}{2} =
    (\sin\theta_i + \sin\theta_o)/(\cos\theta_i + \cos\theta_o)$, $1 - |\cos\phi| =
    \sin^2\phi / (1 + |\cos\phi|)$, and with $u = 1 - 2\beta/\pi$ the bracket of $C_2$
    for $\cos\phi < 0$ is $u\,(3 - 3u + u^2) - \cos^2\alpha/(1 + \sin\alpha)$, whose
    digits survive the product with $\tan\beta$ at grazing.

    Range:
        Equals Lambert at $\sigma = 0$. Negative for dark surfaces with
        $\sigma > 0.66$, where light and viewer are at opposite azimuths and both more
        than 60 degrees from the normal: down to $-0.27\,\rho/\pi$ at grazing,
        $\sigma = \pi/2$ and $\rho \to 0$. With $\rho = 1$ the directional albedo
        exceeds 1 towards grazing for every $\sigma$ up to 0.6, by up to 5.1 % at
        $\sigma = 0.30$ and 90 degrees.

    Source:
        M. Oren and S. K. Nayar, "Generalization of Lambert's Reflectance Model",
        SIGGRAPH 1994, eq. 27-29, https://doi.org/10.1145/192161.192213
    """

    albedo: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol=r"\rho",
        spectral=True,
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
        sin_i, sin_o = numerics.norm_of(xi, yi), numerics.norm_of(xo, yo)
        ui, vi = numerics.divide(xi, sin_i), numerics.divide(yi, sin_i)
        uo, vo = numerics.divide(xo, sin_o), numerics.divide(yo, sin_o)
        cos_phi, sin_phi = ui * uo + vi * vo, ui * vo - vi * uo
        together = xi * xo + yi * yo  # cos(phi) sin(alpha) sin(beta)
        sin_alpha, cos_alpha = jnp.maximum(sin_i, sin_o), jnp.minimum(cos_i, cos_o)
        sin_beta, cos_beta = jnp.minimum(sin_i, sin_o), jnp.maximum(cos_i, cos_o)
        alpha = 2 / jnp.pi * sin_alpha * numerics.angle_ratio(sin_alpha, cos_alpha)
        rise = 2 / jnp.pi * numerics.angle_ratio(cos_beta, sin_beta)
        u = rise * cos_beta
        beta = 1 - u  # both angles as fractions of a right angle

        variance = self.sigma * self.sigma
        facing = rise * (3 - 3 * u + u * u)
        facing -= cos_alpha * cos_alpha / (cos_beta * (1 + sin_alpha))
        facing = numerics.divide(facing, sin_alpha)
        sideways = 0.125 * (alpha * beta) ** 2 * sin_phi**2 / (1 + jnp.abs(cos_phi))
        azimuthal = 0.45 * together * jnp.where(together < 0, facing, 1 / cos_beta)
        azimuthal += sideways * (sin_i + sin_o) / (cos_i + cos_o)
        single = 1 - 0.5 * variance / (variance + 0.33)
        single += variance / (variance + 0.09) * azimuthal
        twice = 0.17 * variance / (variance + 0.13) * (1 - cos_phi * beta * beta)
        return self.albedo / jnp.pi * (single + self.albedo * twice)
