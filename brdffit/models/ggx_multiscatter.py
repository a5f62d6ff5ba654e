"""GGX facets that lose no energy."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import (
    fresnel,
    masking_shadowing,
    multiple_scattering,
    ndf,
)
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class GGXMultiscatter(AbstractBRDF):
    r"""Lambertian base plus a GGX lobe with the light that facets reflect again.

    $$f_r = \frac{k_d}{\pi} + \frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}
            + \frac{\bar F^2 \bar E}{1 - \bar F (1 - \bar E)}\,
            \frac{(1 - E(\omega_i))(1 - E(\omega_o))}{\pi\,(1 - \bar E)}$$

    with Schlick's $F$, its mean $\bar F = F_0 + (1 - F_0)/21$, the albedo $E$ of the
    lobe for $F = 1$ and its mean $\bar E$, height-correlated masking throughout. How
    $E$ is found is told in `microfacet.multiple_scattering`.

    Range:
        $f_r \ge 0$. With $k_d = 0$ and $F_0 = 1$ the directional albedo is 1 at every
        angle and roughness, where single scattering at $\alpha = 1$ keeps
        $1 - \log 2 = 0.31$ at normal incidence. The base is not attenuated by the lobe:
        with $k_d + F_0 = 1$ the albedo exceeds 1 towards grazing, for $F_0 = 0.04$,
        $\alpha = 0.3$ beyond 48 degrees, up to 1.15 at 90 degrees.

    Source:
        C. Kulla and A. Conty, "Revisiting Physically Based Shading at Imageworks",
        SIGGRAPH 2017 course notes; colour factor of S. Hill, "A Multi-Faceted
        Exploration", part 3, 2018.
    """

    diffuse: Spectrum = parameter(
        0.0,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_d",
        spectral=True,
        linear=True,
    )
    f0: Spectrum = parameter(
        0.9,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="F_0",
        spectral=True,
    )
    alpha: Scalar = parameter(
        0.5,
        bounds=(1e-4, 1.0),
        typical=(0.02, 0.8),
        symbol=r"\alpha",
        logarithmic=True,
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.ggx(wh, self.alpha, self.alpha)
        f = fresnel.schlick(fresnel.cos_d(wh), self.f0)
        g = masking_shadowing.smith_ggx(wi, wo, self.alpha, self.alpha, False)
        again = multiple_scattering.kulla_conty(wi, wo, self.f0, self.alpha)
        return self.diffuse / jnp.pi + f * (d * g) + again
