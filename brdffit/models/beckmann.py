"""A diffuse base and a Beckmann highlight."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class Beckmann(AbstractBRDF):
    r"""Lambertian base plus a lobe: Beckmann ndf, exact Smith masking, Schlick Fresnel.

    $$f_r = \frac{k_d}{\pi} + \frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    Range:
        $f_r \ge 0$; single scattering only, so energy is lost as $\alpha$ grows.
        The base is not attenuated by the lobe: with $k_d + F_0 = 1$ the albedo exceeds
        1 towards grazing, where Schlick's factor goes to 1: for $F_0 = 0.04$,
        $\alpha = 0.3$ beyond 16 degrees, up to 1.29 at 90 degrees.

    Source:
        B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces",
        EGSR 2007, eq. 20 and 25.
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
        d = ndf.beckmann(wh, self.alpha, self.alpha)
        f = fresnel.schlick(fresnel.cos_d(wh), self.f0)
        g = masking_shadowing.smith_beckmann(
            wi, wo, self.alpha, self.alpha, self.separable
        )
        return self.diffuse / jnp.pi + f * (d * g)
