"""Reflection from rough glass: Beckmann facets, exact Fresnel factor."""

from typing import ClassVar

import equinox as eqx

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class DielectricBeckmann(AbstractBRDF):
    r"""Reflection at rough glass: Beckmann ndf, Smith masking, dielectric Fresnel.

    $$f_r = k_s\,\frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    Range:
        $f_r \ge 0$; reflection only, what is transmitted is lost. For $\alpha = 0.3$,
        $\eta = 1.5$ the directional albedo is 0.040 at normal incidence and 0.323
        towards grazing.

    Source:
        B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces",
        EGSR 2007, eq. 20 with the ndf of eq. 25.
    """

    specular: Spectrum = parameter(
        1.0,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_s",
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
    eta: Scalar = parameter(1.5, bounds=(1.0, 4.0), typical=(1.2, 2.5), symbol=r"\eta")
    separable: bool = eqx.field(static=True, default=False)

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.beckmann(wh, self.alpha, self.alpha)
        f = fresnel.dielectric(fresnel.cos_d(wh), self.eta)
        g = masking_shadowing.smith_beckmann(
            wi, wo, self.alpha, self.alpha, self.separable
        )
        return self.specular * (d * f * g)
