"""A GGX highlight alone."""

from typing import ClassVar

import equinox as eqx

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class GGXLobe(AbstractBRDF):
    r"""The specular part of `ggx`: a second lobe without a second base, for sums.

    $$f_r = \frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    Range:
        $f_r \ge 0$; single scattering only: with $F_0 = 1$ the directional albedo at
        normal incidence falls to $1 - \log 2 = 0.307$ at $\alpha = 1$. With $F_0 = 0$
        it still reflects at grazing angles, where $F$ rises to 1: a sum with this lobe
        does not contain the model without it, and may fit worse.

    Source:
        B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces",
        EGSR 2007, eq. 20 and 33.
    """

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
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.ggx(wh, self.alpha, self.alpha)
        f = fresnel.schlick(fresnel.cos_d(wh), self.f0)
        g = masking_shadowing.smith_ggx(wi, wo, self.alpha, self.alpha, self.separable)
        return f * (d * g)
