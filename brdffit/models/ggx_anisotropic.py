"""A diffuse base and a highlight of a brushed surface."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class GGXAnisotropic(AbstractBRDF):
    r"""Lambertian base plus an anisotropic GGX lobe; the tangent is $x$.

    $$f_r = \frac{k_d}{\pi} + \frac{D(\omega_h)\,F(\omega_i\cdot\omega_h)\,
            G(\omega_i, \omega_o)}{4\cos\theta_i\cos\theta_o}$$

    $$D = \frac{1}{\pi\,\alpha_x\alpha_y\,\bigl((h_x/\alpha_x)^2 + (h_y/\alpha_y)^2
          + h_z^2\bigr)^2}$$

    Range:
        $f_r \ge 0$; single scattering only, so energy is lost as $\alpha$ grows.
        The base is not attenuated by the lobe: with $k_d + F_0 = 1$ the albedo exceeds
        1 towards grazing, where Schlick's factor goes to 1: for $F_0 = 0.04$,
        $\alpha_x = 0.1$, $\alpha_y = 0.4$ beyond 47 degrees along x, up to 1.43 at 90
        degrees, and beyond 52 degrees along y, up to 1.10.

    Source:
        E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
        BRDFs", JCGT 3(2), 2014, section 5.3; ndf as in B. Burley, "Physically-Based
        Shading at Disney", SIGGRAPH 2012 course notes, appendix B.
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
    separable: bool = eqx.field(static=True, default=False)

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False
    isotropic: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        d = ndf.ggx(wh, self.alpha_x, self.alpha_y)
        f = fresnel.schlick(fresnel.cos_d(wh), self.f0)
        g = masking_shadowing.smith_ggx(
            wi, wo, self.alpha_x, self.alpha_y, self.separable
        )
        return self.diffuse / jnp.pi + f * (d * g)
