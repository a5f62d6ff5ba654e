"""Disney's principled model."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class Principled(AbstractBRDF):
    r"""Disney's model: a rough diffuse base or a metal, with sheen and a clear coat.

    $$f_r = (1 - m)\,\bigl(f_d + s\,(1 - c)^5\bigr)
            + \frac{D_{GGX}\,F(c)\,G}{4\cos\theta_i\cos\theta_o}
            + \frac{k_c}{4}\,\frac{D_{GTR1}\,F_c(c)\,G_c}{4\cos\theta_i\cos\theta_o}$$

    $$f_d = \frac{b}{\pi}\,\bigl(1 + (F_{90} - 1)(1 - \cos\theta_i)^5\bigr)
            \bigl(1 + (F_{90} - 1)(1 - \cos\theta_o)^5\bigr), \qquad
      F_{90} = \tfrac12 + 2 r c^2$$

    with $c = \omega_i\cdot\omega_h$, $\alpha = \max(0.001, r^2)$ and Schlick's $F$ from
    $F_0 = 0.08\,(1 - m)\,p + m\,b$. The coat has $F_0 = 0.04$,
    $\alpha = 0.1 - 0.099\,g$, and masking of $\alpha = 0.25$. Masking is that of the
    2014 revision, height-correlated here unless `separable`. Tints, anisotropy and
    subsurface scattering of the original are left out.

    Range:
        $f_r \ge 0$. Not energy conserving: for $b = 1$, $m = 0$ the base alone has an
        albedo of 1.006 at normal incidence for $r = 0.5$ and of 1.036 for $r = 1$,
        where it grows to 1.56 towards grazing; sheen, gloss and coat add to it.

    Source:
        B. Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course notes,
        section 5 and appendix B; "Extending the Disney BRDF to a BSDF with Integrated
        Subsurface Scattering", SIGGRAPH 2015 course notes, for the masking.
    """

    base: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="b",
        spectral=True,
    )
    metallic: Scalar = parameter(0.0, bounds=(0.0, 1.0), typical=(0.0, 1.0), symbol="m")
    roughness: Scalar = parameter(
        0.5, bounds=(0.0, 1.0), typical=(0.15, 0.9), symbol="r"
    )
    specular: Scalar = parameter(0.5, bounds=(0.0, 1.0), typical=(0.0, 1.0), symbol="p")
    sheen: Scalar = parameter(0.0, bounds=(0.0, 1.0), typical=(0.0, 1.0), symbol="s")
    clearcoat: Scalar = parameter(
        0.0, bounds=(0.0, 1.0), typical=(0.0, 1.0), symbol="k_c"
    )
    clearcoat_gloss: Scalar = parameter(
        1.0, bounds=(0.0, 1.0), typical=(0.0, 1.0), symbol="g"
    )
    separable: bool = eqx.field(static=True, default=False)

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False

    @property
    def diffuse_reflectance(self) -> Spectrum:
        """Reflectance of the part that is no metal."""
        return (1 - self.metallic) * self.base

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        cos_d = fresnel.cos_d(wh)
        base = diffuse(wi[2], wo[2], cos_d, self.roughness) * self.base
        base += self.sheen * fifth(1 - cos_d)
        f0 = (1 - self.metallic) * 0.08 * self.specular + self.metallic * self.base
        alpha = jnp.maximum(self.roughness * self.roughness, 0.001)
        d = ndf.ggx(wh, alpha, alpha)
        g = masking_shadowing.smith_ggx(wi, wo, alpha, alpha, self.separable)
        gloss = fresnel.schlick(cos_d, f0) * (d * g)
        coat = clearcoat(wi, wo, self.clearcoat_gloss, self.separable)
        return (1 - self.metallic) * base + gloss + self.clearcoat * coat


def diffuse(cos_i: Scalar, cos_o: Scalar, cos_d: Scalar, roughness: Scalar) -> Scalar:
    """The base, for a white one: darker or brighter than Lambert's towards grazing."""
    rise = 2 * roughness * cos_d * cos_d - 0.5
    return (1 + rise * fifth(1 - cos_i)) * (1 + rise * fifth(1 - cos_o)) / jnp.pi


def clearcoat(wi: Direction, wo: Direction, gloss: Scalar, separable: bool) -> Scalar:
    """The coat at full strength."""
    wh, quarter = bisector(wi, wo), jnp.full_like(gloss, 0.25)
    alpha = 0.1 - 0.099 * gloss
    d = ndf.gtr1(wh, alpha, alpha)
    f = fresnel.schlick(fresnel.cos_d(wh), jnp.full_like(gloss, 0.04))
    g = masking_shadowing.smith_ggx(wi, wo, quarter, quarter, separable)
    return 0.25 * d * f * g


def fifth(x: Scalar) -> Scalar:
    """Fifth power."""
    square = x * x
    return square * square * x
