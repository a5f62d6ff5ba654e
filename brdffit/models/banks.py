"""Light on fibres: a lobe about the cone of directions that a thread reflects to."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class Banks(AbstractBRDF):
    r"""Diffuse base plus the reflection of fibres that run along the tangent $T$.

    $$f_r = \frac{k_d}{\pi} + k_s\,\max\Bigl(0,\;
            \sqrt{1 - (\omega_i\cdot T)^2}\,\sqrt{1 - (\omega_o\cdot T)^2}
            - (\omega_i\cdot T)(\omega_o\cdot T)\Bigr)^p$$

    Every plane through $T$ reflects alike, so a fibre sends light into a cone about
    itself. With $t = \omega\cdot T$ and $s = \sqrt{1 - t^2}$, which is
    $\sqrt{y^2 + z^2}$ and so keeps its digits, the base of the power is, where it is
    close to 1, $1 - \bigl((t_i + t_o)^2 + (s_i - s_o)^2\bigr)/2$. No cosine to the
    normal enters, as in the paper's specular term, and the lobe is not normalised.

    Range:
        $f_r \ge 0$; not energy conserving: for $k_d = k_s = 0.5$, $p = 10$ the albedo
        is 1.21 at normal incidence. That of the lobe for light across the fibres is
        $2\,\mathrm{B}(1/2, (p + 3)/2)\,k_s$, which is 0.50 at $p = 100$.

    Source:
        D. C. Banks, "Illumination in Diverse Codimensions", SIGGRAPH 1994,
        https://doi.org/10.1145/192161.192227
    """

    diffuse: Spectrum = parameter(
        0.5,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_d",
        spectral=True,
        linear=True,
    )
    specular: Spectrum = parameter(
        0.3,
        bounds=(0.0, 1.0),
        typical=(0.02, 0.98),
        symbol="k_s",
        spectral=True,
        linear=True,
    )
    exponent: Scalar = parameter(
        50.0,
        bounds=(0.0, 1e5),
        typical=(1.0, 2000.0),
        symbol="p",
        logarithmic=True,
    )

    reciprocal: ClassVar[bool] = True
    energy_conserving: ClassVar[bool] = False
    isotropic: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        (ti, yi, zi), (to, yo, zo) = wi, wo
        si, so = numerics.norm_of(yi, zi), numerics.norm_of(yo, zo)
        along, across = ti + to, si - so
        deficit = 0.5 * (along * along + across * across)
        lobe = numerics.pow_near_one(si * so - ti * to, deficit, self.exponent)
        return self.diffuse / jnp.pi + self.specular * lobe
