"""Light as a wave on a rough surface: the model of He and Torrance."""

from typing import ClassVar

import jax
import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import bisector, cos_theta, mirror
from brdffit.microfacet import diffraction, fresnel, masking_shadowing
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import known, parameter
from brdffit.types import Direction, Scalar, Spectrum


class He(AbstractBRDF):
    r"""Scattering by a random rough surface, from physical optics, unpolarised.

    $$f_r = \frac{F\,S}{\pi\cos\theta_i\cos\theta_o}\,
            \Bigl(\frac{|H|^2}{H_z}\Bigr)^2\,\frac{\pi^2\tau^2}{4\lambda^2}
            \sum_{m=1}^\infty \frac{g^m e^{-g}}{m!\,m}\,e^{-c/m} + \frac{a}{\pi}$$

    $$g = \Bigl(\frac{2\pi\sigma}{\lambda}(\cos\theta_i + \cos\theta_o)\Bigr)^2, \qquad
      c = \Bigl(\frac{\pi\tau}{\lambda}\Bigr)^2 (H_x^2 + H_y^2)$$

    with $H = \omega_i + \omega_o$, the conductor's $F$ at half the angle between the
    directions, the roughness $\sigma$ of what is lit and seen (told in
    `microfacet.diffraction`) and Smith's separable $S$ for slopes of
    $\alpha = 2\sigma_0/\tau$. Lengths `sigma0`, `tau` and `wavelengths` are in
    micrometres. `diffuse` is the reflectance of what is scattered below the surface.

    The sum is taken over the orders that matter, by their logarithms, and times
    $1 + g$, by which the factor before it is divided: on a rough surface neither then
    depends on the wavelength, as the reflectance does not. Two things differ from the
    printed paper. Its $\Lambda$, eq. 25, lacks the factor $e^{-x^2}$, as its
    errata say. Its $G$, eq. 76, is $(|H|^2/H_z)^2$ times a ratio of products of
    polarisation vectors that is 1 for all directions, and 0/0 in the retro direction.

    The mirror image of a light is a delta function and no part of `f_r`; its strength
    is `specular_reflectance`.

    Range:
        $f_r \ge 0$. With the mirror image and $F = 1$ albedo is 1 at normal incidence
        on a gentle surface, and exceeds 1 at grazing angles by up to 1 %
        ($\sigma_0 = 0.01$, $\tau = 0.1$, $\lambda = 0.4$, 60 degrees: 1.011). What
        strikes twice is lost: at $\sigma_0 = \tau = 0.5$, where slopes are steep,
        0.089 remains at normal incidence.

    Source:
        X. D. He, K. E. Torrance, F. X. Sillion and D. P. Greenberg, "A Comprehensive
        Physical Model for Light Reflection", SIGGRAPH 1991, eq. 24, 25 and 76-83,
        https://doi.org/10.1145/127719.122738
    """

    sigma0: Scalar = parameter(
        0.1,
        bounds=(1e-4, 20.0),
        typical=(0.01, 1.0),
        unit="um",
        symbol=r"\sigma_0",
        logarithmic=True,
    )
    tau: Scalar = parameter(
        2.0,
        bounds=(1e-2, 200.0),
        typical=(0.25, 10.0),
        unit="um",
        symbol=r"\tau",
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
    diffuse: Spectrum = parameter(
        0.1,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="a",
        spectral=True,
        linear=True,
    )
    wavelengths: Spectrum = known(0.55, unit="um", symbol=r"\lambda")

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False
    lobe = staticmethod(diffraction.scattering_lobe)

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        wh = bisector(wi, wo)
        x, y, z = wh
        length = fresnel.cos_d(wh) * 2
        f = fresnel.conductor(length / 2, self.eta, self.k)
        width = jnp.pi * self.tau
        width /= numerics.norm_of(self.wavelengths, self.path(wi, wo))
        width *= width
        lobe = jax.vmap(self.lobe)(self.phase(wi, wo), width * (x * x + y * y))
        g = length * (length / z)
        shadowing = self.shadowing(wi) * self.shadowing(wo)
        scattered = f * (g * g * shadowing) * (width / 4) * lobe
        return (scattered + self.diffuse) / jnp.pi

    def specular_reflectance(self, wi: Direction) -> Spectrum:
        """Share of light from ``wi`` that goes to its mirror image as from a mirror."""
        f = fresnel.conductor(cos_theta(wi), self.eta, self.k)
        seen = self.shadowing(wi) * cos_theta(wi)
        return f * jnp.exp(-self.phase(wi, mirror(wi))) * (seen * seen)

    def phase(self, wi: Direction, wo: Direction) -> Spectrum:
        """Square of the roughness in phase between two directions, ``g``."""
        phase = self.path(wi, wo) / self.wavelengths
        return phase * phase

    def path(self, wi: Direction, wo: Direction) -> Scalar:
        """Root of ``g`` before it is divided by the wavelength."""
        sigma = diffraction.effective_roughness(wi, wo, self.sigma0, self.tau)
        return 2 * jnp.pi * sigma * (cos_theta(wi) + cos_theta(wo))

    def shadowing(self, w: Direction) -> Scalar:
        """Factor of ``S`` that one direction contributes, over its cosine."""
        alpha = 2 * self.sigma0 / self.tau
        area = masking_shadowing.area_beckmann(w, alpha, alpha)
        return diffraction.lit_share(w, self.sigma0, self.tau) / area
