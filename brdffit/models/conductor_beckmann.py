"""Rough metal: Beckmann facets with the exact Fresnel factor."""

from typing import ClassVar

import equinox as eqx

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class ConductorBeckmann(AbstractBRDF):
    r"""Microfacets of a metal: Beckmann ndf, exact Smith masking, conductor Fresnel.

    $$f_r = k_s\,\frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    Range:
        $f_r \ge 0$; single scattering only. For $\alpha = 0.3$, $\eta = 0.2$,
        $k = 3.9$ the directional albedo is 0.9516 at normal incidence and 0.866 at 80
        degrees. Masking is exact: with the usual rational approximation values differ
        by up to 0.6 %.

    Source:
        K. Torrance and E. Sparrow, "Theory for Off-Specular Reflection From Roughened
        Surfaces", JOSA 57(9), 1967; in this form B. Walter et al., "Microfacet Models
        for Refraction through Rough Surfaces", EGSR 2007, eq. 20
        with the ndf of eq. 25.
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
    eta: Spectrum = parameter(
        0.5,
        bounds=(0.01, 10.0),
        typical=(0.1, 4.0),
        symbol=r"\eta",
        spectral=True,
        logarithmic=True,
    )
    k: Spectrum = parameter(
        3.0, bounds=(0.0, 20.0), typical=(0.0, 8.0), symbol="k", spectral=True
    )
    separable: bool = eqx.field(static=True, default=False)

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.beckmann(wh, self.alpha, self.alpha)
        f = fresnel.conductor(fresnel.cos_d(wh), self.eta, self.k)
        g = masking_shadowing.smith_beckmann(
            wi, wo, self.alpha, self.alpha, self.separable
        )
        return self.specular * f * (d * g)
