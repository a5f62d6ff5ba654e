"""The everyday material: a diffuse base and a GGX highlight."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class GGX(AbstractBRDF):
    r"""Lambertian base plus a microfacet lobe: GGX ndf, Smith masking, Schlick Fresnel.

    $$f_r = \frac{k_d}{\pi} + \frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    Range:
        $f_r \ge 0$; single scattering only, so energy is lost as $\alpha$ grows. The
        base is not attenuated by the lobe: with $k_d + F_0 = 1$ the albedo exceeds 1
        towards grazing, where Schlick's factor goes to 1. For $F_0 = 0.04$ that is
        beyond 35, 50 and 74 degrees for $\alpha = 0.1$, 0.3 and 0.8, up to 1.38, 1.15
        and 1.06 at 90 degrees.

    Source:
        B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces",
        EGSR 2007, eq. 20 and 33.
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
    separable: bool = eqx.field(static=True, default=False)

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.ggx(wh, self.alpha, self.alpha)
        f = fresnel.schlick(fresnel.cos_d(wh), self.f0)
        g = masking_shadowing.smith_ggx(wi, wo, self.alpha, self.alpha, self.separable)
        return self.diffuse / jnp.pi + d * f * g
