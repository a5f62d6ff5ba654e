"""Anisotropic gloss: the model of 1992."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import bisector
from brdffit.microfacet import ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class Ward(AbstractBRDF):
    r"""Ward's anisotropic gloss: a Gaussian of the half vector's slopes.

    $$f_r = \frac{k_d}{\pi} + k_s\,\frac{E(\omega_h)}
            {4\pi\,\alpha_x\alpha_y\sqrt{\cos\theta_i\cos\theta_o}}, \qquad
      E = \exp\Bigl(-\frac{(h_x/\alpha_x)^2 + (h_y/\alpha_y)^2}{h_z^2}\Bigr)$$

    This is the exact exponent of eq. 5a; the cheaper one of eq. 5b differs at large
    slopes. $\alpha$ is $\sqrt 2$ times the standard deviation of the slopes.

    Range:
        $f_r \ge 0$ and grows without bound towards grazing, with an albedo of
        $C / \sqrt{\cos\theta}$: for $\alpha = 0.3$ and $k_s = 1$ it is 0.79 at normal
        incidence, falls to 0.24 at 80 degrees, and exceeds 1 beyond 89.89 degrees
        ($C = 0.043$; for $\alpha = 0.1$ beyond 89.993 degrees). `ward_bounded` mends
        both ends.

    Source:
        G. J. Ward, "Measuring and Modeling Anisotropic Reflection", SIGGRAPH 1992,
        eq. 5a, https://doi.org/10.1145/133994.134078
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
        # a root each: the product of two grazing cosines underflows in the gradient
        shadowing = 4 * jnp.pi * numerics.sqrt(wi[2]) * numerics.sqrt(wo[2])
        gloss = lobe / (self.alpha_x * self.alpha_y) / shadowing
        return self.diffuse / jnp.pi + self.specular * gloss
