"""The Blinn-Phong shading equation, read as a BRDF."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit.geometry import bisector, tan_squared
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class BlinnPhongOriginal(AbstractBRDF):
    r"""Blinn's half-vector shading equation divided by the incident cosine.

    $$f_r = k_d + k_s\,\frac{(\cos\theta_h)^p}{\cos\theta_i}$$

    The weights are those of the shading equation: $k_d$ carries no $1/\pi$, so the
    albedo of the diffuse part is $\pi k_d$. The power is evaluated as
    $\exp(-\tfrac{p}{2}\log(1 + \tan^2\theta_h))$.

    Range:
        $f_r \ge 0$, without bound as $\theta_i$ goes to 90 degrees: not reciprocal, not
        energy conserving. With $k_d = k_s = 0.5$ and $p = 10$ the directional albedo is
        2.32 at normal incidence, 6.14 at 89 degrees and 430 at 89.99 degrees.

    Source:
        J. F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures",
        SIGGRAPH 1977, https://doi.org/10.1145/563858.563893
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

    reciprocal: ClassVar[bool] = False
    energy_conserving: ClassVar[bool] = False

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        lobe = jnp.exp(-0.5 * self.exponent * jnp.log1p(tan_squared(bisector(wi, wo))))
        return self.diffuse + self.specular * (lobe / wi[2])
