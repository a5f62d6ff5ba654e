"""Anisotropic gloss: Ward's model with Duer's normalisation."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class WardDuer(AbstractBRDF):
    r"""Ward's gloss divided by the product of the cosines instead of its root.

    $$f_r = \frac{k_d}{\pi} + k_s\,\frac{E(\omega_h)}
            {4\pi\,\alpha_x\alpha_y\cos\theta_i\cos\theta_o}, \qquad
      E = \exp\Bigl(-\frac{(h_x/\alpha_x)^2 + (h_y/\alpha_y)^2}{h_z^2}\Bigr)$$

    Range:
        $f_r \ge 0$ and grows without bound towards grazing, faster than `ward`, with an
        albedo of $C / \cos\theta$. For $\alpha = 0.3$ and $k_s = 1$ it stays between
        0.82 and 0.86 up to 60 degrees, exceeds 1 beyond 82.1 degrees ($C = 0.067$), and
        is 4.3 at 89 degrees; for $\alpha = 0.1$ it exceeds 1 beyond 85.6 degrees.

    Source:
        A. Duer, "An Improved Normalization for the Ward Reflectance Model", Journal of
        Graphics Tools 11(1), 2006, https://doi.org/10.1080/2151237X.2006.10129215
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
    alpha_x: Scalar = parameter(
        0.1,
        bounds=(1e-4, 1.0),
        typical=(0.02, 0.8),
        symbol=r"\alpha_x",
        logarithmic=True,
    )
    alpha_y: Scalar = parameter(
        0.3,
        bounds=(1e-4, 1.0),
        typical=(0.02, 0.8),
        symbol=r"\alpha_y",
        logarithmic=True,
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False
    isotropic: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        lobe = ndf.slope_gaussian(bisector(wi, wo), self.alpha_x, self.alpha_y)
        shadowing = 4 * jnp.pi * wi[2] * wo[2]
        gloss = lobe / (self.alpha_x * self.alpha_y) / shadowing
        return self.diffuse / jnp.pi + self.specular * gloss
