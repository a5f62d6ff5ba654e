"""The first microfacet model of computer graphics."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class CookTorrance(AbstractBRDF):
    r"""Diffuse base plus a lobe: Beckmann ndf, V-cavity masking, Schlick Fresnel.

    $$f_r = \frac{k_d}{\pi} + k_s\,\frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    The paper prints $F D' G / (\pi\cos\theta_i\cos\theta_o)$. With its ndf normalised
    that is four times as much and reflects more than it receives; the factor here is
    1/4, as in Torrance and Sparrow and in all later work.

    Range:
        $f_r \ge 0$; directional albedo at most $k_d + k_s$. Facets in a V-cavity mask
        only one another, so at high roughness the lobe is dark at normal incidence:
        0.453 for $\alpha = 1$, $F_0 = 1$.

    Source:
        R. L. Cook and K. E. Torrance, "A Reflectance Model for Computer Graphics", ACM
        TOG 1(1), 1982, https://doi.org/10.1145/357290.357293
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
    f0: Scalar = parameter(0.04, bounds=(0.0, 1.0), typical=(0.02, 0.98), symbol="F_0")
    alpha: Scalar = parameter(
        0.3,
        bounds=(1e-4, 1.0),
        typical=(0.02, 0.8),
        symbol=r"\alpha",
        logarithmic=True,
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.beckmann(wh, self.alpha, self.alpha)
        f = fresnel.schlick(fresnel.cos_d(wh), self.f0)
        g = masking_shadowing.v_cavity(wi, wo)
        return self.diffuse / jnp.pi + self.specular * (d * f * g)
