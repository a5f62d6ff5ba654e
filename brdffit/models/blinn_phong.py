"""A diffuse base and a lobe about the half vector."""

from typing import ClassVar

import jax.numpy as jnp

from brdffit.geometry import bisector, tan_squared
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameter
from brdffit.types import Direction, Scalar, Spectrum


class BlinnPhong(AbstractBRDF):
    r"""Blinn-Phong model, normalised exactly.

    $$f_r = \frac{k_d}{\pi} + k_s\,\frac{(p + 2)(p + 4)}{8\pi\,(2^{-p/2} + p)}\,
            (\cos\theta_h)^p$$

    The power is evaluated as $\exp(-\tfrac{p}{2}\log(1 + \tan^2\theta_h))$.

    Range:
        $f_r \ge 0$; directional albedo at most $k_d + k_s$, reached at normal
        incidence. The lobe darkens towards grazing: for $p = 10$ its albedo is 0.40 at
        60 degrees and 0.11 at 89 degrees. The common factor $(p + 8)/(8\pi)$ exceeds 1
        by up to 7.5 % and is not used.

    Source:
        J. F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures",
        SIGGRAPH 1977, https://doi.org/10.1145/563858.563893; factor: F. Giesen, "Phong
        Normalization Factor Derivation", 2009.
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
    energy_conserving: ClassVar[bool] = True

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        p = self.exponent
        lobe = jnp.exp(-0.5 * p * jnp.log1p(tan_squared(bisector(wi, wo))))
        peak = (p + 2) * (p + 4) / (8 * jnp.pi * (jnp.exp2(-0.5 * p) + p))
        return self.diffuse / jnp.pi + self.specular * (peak * lobe)
