"""A diffuse base under a rough clear coat."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class PlasticGGX(AbstractBRDF):
    r"""Diffuse base under a rough dielectric coat, with reflection inside the coat.

    $$f_r = \frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}
            + \frac{k_d}{\pi}\,\frac{(1 - F(\cos\theta_i))(1 - F(\cos\theta_o))}
            {\eta^2\,(1 - k_d F_{in})}, \qquad
      F_{in} = 1 - \frac{1}{\eta^2}\,2\!\int_0^1 (1 - F(c))\,c\,dc$$

    with the exact dielectric $F$: light enters and leaves through a smooth interface,
    and is partly sent back to the base from inside.

    Range:
        $f_r \ge 0$. Light that the rough lobe reflects is taken from the base as if the
        interface were smooth. Mostly that is too much: for $k_d = 1$, $\alpha = 0.3$,
        $\eta = 1.5$ the albedo is 0.996 at normal incidence and 0.20 towards grazing.
        Where it is too little, albedo exceeds 1 by at most 0.07 %, near 50 degrees at
        $\alpha = 0.1$, $\eta = 1.25$. A base lit and seen through the rough interface,
        as Mitsuba tabulates it, is darker at normal incidence (by 5 % for
        $\alpha = 0.15$, 17 % for $\alpha = 0.4$) and brighter towards grazing.

    Source:
        W. Jakob, *Mitsuba*, plugin `roughplastic`; lobe of B. Walter et al.,
        "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, eq. 20.
    """

    diffuse: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_d",
        spectral=True,
    )
    alpha: Scalar = parameter(
        0.1,
        bounds=(1e-4, 1.0),
        typical=(0.02, 0.8),
        symbol=r"\alpha",
        logarithmic=True,
    )
    eta: Scalar = parameter(
        1.5,
        bounds=(1.0, 4.0),
        typical=(1.2, 2.5),
        symbol=r"\eta",
    )
    separable: bool = eqx.field(static=True, default=False)

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.ggx(wh, self.alpha, self.alpha)
        f = fresnel.dielectric(fresnel.cos_d(wh), self.eta)
        g = masking_shadowing.smith_ggx(wi, wo, self.alpha, self.alpha, self.separable)
        through = fresnel.dielectric_transmittance(wi[2], self.eta)
        through *= fresnel.dielectric_transmittance(wo[2], self.eta)
        square = self.eta * self.eta
        inside = 1 - fresnel.diffuse_transmittance(self.eta) / square
        base = self.diffuse / (1 - self.diffuse * inside)
        return d * f * g + base * (through / (jnp.pi * square))
