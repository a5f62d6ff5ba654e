"""A cosine lobe about a linear image of the mirror direction."""

from typing import ClassVar

import jax
import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import mirror_deficit
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum

Coefficients = tuple[Scalar, Scalar, Scalar]


class Lafortune(AbstractBRDF):
    r"""Diffuse base plus one generalised cosine lobe.

    $$f_r = \frac{k_d}{\pi} + k_s\,
            \max(0,\; C_x x_i x_o + C_y y_i y_o + C_z z_i z_o)^p$$

    $-C_x = -C_y = C_z = 1$ is the Phong lobe, $C_x = C_y$ an isotropic one; $C_z$ below
    $-C_x$ makes it lean towards grazing, positive $C_x$ and $C_y$ reflect back to the
    light. Near 1 the power is taken of 1 minus
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
        c = (self.c_x, self.c_y, self.c_z)
        image, deficit = image_cosine(c, wi, wo), image_deficit(c, wi, wo)
        lobe = numerics.pow_near_one(image, deficit, self.exponent)
        return self.diffuse / jnp.pi + self.specular * lobe


def image_cosine(c: Coefficients, wi: Direction, wo: Direction) -> Scalar:
    """Scalar product of ``wo`` with the linear image of ``wi``."""
    (c_x, c_y, c_z), (xi, yi, zi), (xo, yo, zo) = c, wi, wo
    return c_x * (xi * xo) + c_y * (yi * yo) + c_z * (zi * zo)


@jax.custom_jvp
def image_deficit(c: Coefficients, wi: Direction, wo: Direction) -> Scalar:
    """1 minus `image_cosine`, from what is small near the mirror direction."""
    return _image_deficit(c, wi, wo)


def _image_deficit(c: Coefficients, wi: Direction, wo: Direction) -> Scalar:
    (c_x, c_y, c_z), (xi, yi, _), (xo, yo, _) = c, wi, wo
    tilt = (c_x + c_z) * (xi * xo) + (c_y + c_z) * (yi * yo)
    return (1 - c_z) + c_z * mirror_deficit(wi, wo) - tilt


@image_deficit.defjvp
def _image_deficit_jvp(primals, tangents):
    # by the coefficients it is a plain product, of which small terms would cancel
    (c, wi, wo), (dc, dwi, dwo) = primals, tangents
    value, by_directions = jax.jvp(
        lambda wi, wo: _image_deficit(c, wi, wo), (wi, wo), (dwi, dwo)
    )
    return value, by_directions - image_cosine(dc, wi, wo)
