"""A cosine lobe about a linear image of the mirror direction."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import mirror_deficit
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class Lafortune(AbstractBRDF):
    r"""Diffuse base plus one generalised cosine lobe.

    $$f_r = \frac{k_d}{\pi} + k_s\,
            \max(0,\; C_x x_i x_o + C_y y_i y_o + C_z z_i z_o)^p$$

    $-C_x = -C_y = C_z = 1$ is the Phong lobe, $C_x = C_y$ an isotropic one; $C_z$ below
    $-C_x$ makes it lean towards grazing, positive $C_x$ and $C_y$ reflect back to the
    light. The power is taken of 1 minus
    $(1 - C_z) + C_z |\omega_r - \omega_o|^2/2 - (C_x + C_z) x_i x_o
    - (C_y + C_z) y_i y_o$, with $\omega_r$ the mirror image of $\omega_i$, which keeps
    its digits at high exponents.

    Range:
        $f_r \ge 0$; not normalised: the peak is $k_s C^p$ and the albedo has no bound.
        For $C = 0.9$, $p = 10$, $k_d = 0.3$, $k_s = 0.5$ it is 0.39 at normal
        incidence. A lobe beyond the largest number (about $10^{34}$ in single
        precision) stays at that value.

    Source:
        E. P. F. Lafortune, S.-C. Foo, K. E. Torrance and D. P. Greenberg, "Non-Linear
        Approximation of Reflectance Functions", SIGGRAPH 1997,
        https://doi.org/10.1145/258734.258801
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
    c_x: Scalar = parameter(
        -0.9,
        bounds=(-2.0, 2.0),
        typical=(-1.2, -0.6),
        symbol="C_x",
    )
    c_y: Scalar = parameter(
        -0.9,
        bounds=(-2.0, 2.0),
        typical=(-1.2, -0.6),
        symbol="C_y",
    )
    c_z: Scalar = parameter(
        0.9,
        bounds=(0.0, 2.0),
        typical=(0.6, 1.2),
        symbol="C_z",
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

    def lobe_axis(self, wi: Direction) -> Direction:
        x, y, z = wi
        # the normal where all coefficients are 0 and there is no lobe
        up = jnp.maximum(self.c_z * z, 1e-6 * z)
        return numerics.normalize(jnp.stack([self.c_x * x, self.c_y * y, up]))

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        x, y = wi[0] * wo[0], wi[1] * wo[1]
        tilt = (self.c_x + self.c_z) * x + (self.c_y + self.c_z) * y
        deficit = (1 - self.c_z) + self.c_z * mirror_deficit(wi, wo) - tilt
        lobe = numerics.pow_complement(deficit, self.exponent)
        return self.diffuse / jnp.pi + self.specular * lobe
