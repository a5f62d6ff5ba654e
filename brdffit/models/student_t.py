"""A diffuse base and a highlight with tails of any length."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class StudentT(AbstractBRDF):
    r"""Lambertian base plus a microfacet lobe whose slopes follow Student's t.

    $$f_r = \frac{k_d}{\pi} + \frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    $$D = \frac{1}{\pi\,\alpha^2\cos^4\theta_h}\,
          \Bigl(1 + \frac{\tan^2\theta_h}{(\gamma - 1)\,\alpha^2}\Bigr)^{-\gamma}$$

    GGX at $\gamma = 2$, Beckmann as $\gamma \to \infty$. Smith masking is exact: where
    the paper fits a rational function, an integral is taken to 2e-8.

    Range:
        $f_r \ge 0$, $\gamma > 3/2$; single scattering only, so energy is lost as
        $\alpha$ grows and as $\gamma$ falls. The base is not attenuated by the
        lobe: with $k_d + F_0 = 1$ the albedo exceeds 1 towards grazing, where Schlick's
        factor goes to 1: for $F_0 = 0.04$, $\alpha = 0.3$, $\gamma = 3$ beyond 39
        degrees, up to 1.22 at 90 degrees.

    Source:
        M. Ribardiere et al., "STD: Student's t-Distribution of Slopes for Microfacet
        Based BSDFs", Computer Graphics Forum 36(2), 2017,
        https://doi.org/10.1111/cgf.13137
    """

    diffuse: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_d",
        spectral=True,
        linear=True,
    )
    f0: Spectrum = parameter(
        0.04,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="F_0",
        spectral=True,
        linear=True,
    )
    alpha: Scalar = parameter(
        0.3,
        bounds=(1e-4, 1.0),
        typical=(0.02, 0.8),
        symbol=r"\alpha",
        logarithmic=True,
    )
    gamma: Scalar = parameter(
        3.0,
        bounds=(1.51, 40.0),
        typical=(1.6, 20.0),
        symbol=r"\gamma",
        logarithmic=True,
    )
    separable: bool = eqx.field(static=True, default=False)

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.student_t(wh, self.alpha, self.alpha, self.gamma)
        f = fresnel.schlick(fresnel.cos_d(wh), self.f0)
        g = masking_shadowing.smith_student_t(
            wi, wo, self.alpha, self.alpha, self.gamma, self.separable
        )
        return self.diffuse / jnp.pi + f * (d * g)
