r"""Residuals: in which quantity a model is compared with a measurement.

A residual compares $T(f)$ with $T(y)$: prediction and observation after the same
transform. The solver minimises half the weighted sum of squares of the difference. To
add one, write its transform and its line here.
"""

import dataclasses
from collections.abc import Callable
from typing import TypeAlias

import jax.numpy as jnp
from jaxtyping import Array

from brdffit import numerics
from brdffit.samples import Samples

Transform: TypeAlias = Callable[[Array, Array, Array], Array]


@dataclasses.dataclass(frozen=True)
class Residual:
    """A comparison of predicted with observed values.

    Attributes:
        name: Name at the command line.
        transform: ``(value, cos_i, cos_o) -> compared quantity``, elementwise. For
            images ``cos_i`` is 1, because the value is radiance and holds it already.
        inverse: ``(compared quantity, cos_i, cos_o) -> value``.
        affine: True when ``transform`` is affine in the value, which lets the linear
            parameters of a model be eliminated.
        positive: True when only values above 0 can be compared; others are masked.
        label: The compared quantity in words, for axes and tables.
    """

    name: str
    transform: Transform
    inverse: Transform
    affine: bool = False
    positive: bool = False
    label: str = ""

    def on(self, samples: Samples) -> Callable[[Array], Array]:
        """The transform of values ``(N, C)`` of these samples."""
        cosines = jnp.asarray(samples.cosine)[:, None], jnp.asarray(samples.wo)[:, 2:]
        return lambda value: self.transform(value, *cosines)


def _plain(value: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_i, cos_o
    return value


def _value_of_plain(plain: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_i, cos_o
    return plain


def _cosine_weighted(value: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_o
    return value * cos_i


def _value_of_cosine_weighted(weighted: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_o
    return weighted / cos_i


def _log(value: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_i, cos_o
    return numerics.log(value)


def _value_of_log(logarithm: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_i, cos_o
    return jnp.exp(logarithm)


def _log_cosine(value: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_o
    return jnp.log1p(value * cos_i)


def _value_of_log_cosine(logarithm: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_o
    return jnp.expm1(logarithm) / cos_i


def _cube_root(value: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_o
    return numerics.cbrt(value * cos_i)


def _value_of_cube_root(root: Array, cos_i: Array, cos_o: Array) -> Array:
    del cos_o
    return root**3 / cos_i


LOG_RELATIVE_OFFSET = 1e-3


def _log_relative(value: Array, cos_i: Array, cos_o: Array) -> Array:
    return jnp.log(value * cos_i * cos_o + LOG_RELATIVE_OFFSET)


def _value_of_log_relative(logarithm: Array, cos_i: Array, cos_o: Array) -> Array:
    return (jnp.exp(logarithm) - LOG_RELATIVE_OFFSET) / (cos_i * cos_o)


plain = Residual("plain", _plain, _value_of_plain, affine=True, label="$f_r$ [1/sr]")
"""The value itself; squares are dominated by the highlight."""

cosine_weighted = Residual(
    "cosine_weighted",
    _cosine_weighted,
    _value_of_cosine_weighted,
    affine=True,
    label=r"$f_r \cos\theta_i$ [1/sr]",
)
"""Reflected radiance under unit radiance (A. Ngan et al., "Experimental Analysis of
BRDF Models", EGSR 2005, sec. 3)."""

log = Residual("log", _log, _value_of_log, positive=True, label=r"$\ln f_r$")
"""Relative error: a factor counts the same in the highlight and in the base."""

log_cosine = Residual(
    "log_cosine",
    _log_cosine,
    _value_of_log_cosine,
    label=r"$\ln(1 + f_r \cos\theta_i)$",
)
"""J. Low, J. Kronander, A. Ynnerman, J. Unger, "BRDF Models for Accurate and Efficient
Rendering of Glossy Surfaces", ACM TOG 31(1), 2012."""

cube_root = Residual(
    "cube_root",
    _cube_root,
    _value_of_cube_root,
    label=r"$(f_r \cos\theta_i)^{1/3}$ [sr$^{-1/3}$]",
)
"""Close to perceived lightness (A. Fores, J. Ferwerda, J. Gu, "Toward a Perceptually
Based Metric for BRDF Modeling", Color and Imaging Conference 2012)."""

log_relative = Residual(
    "log_relative",
    _log_relative,
    _value_of_log_relative,
    label=r"$\ln(f_r \cos\theta_i \cos\theta_o + 10^{-3})$",
)
"""The log-relative mapping of J. B. Nielsen, H. W. Jensen, R. Ramamoorthi, "On Optimal,
Minimal BRDF Sampling for Reflectance Acquisition", ACM TOG 34(6), 2015, eq. 2; their
reference reflectance cancels in the difference."""

RESIDUALS: dict[str, Residual] = {
    residual.name: residual
    for residual in (plain, cosine_weighted, log, log_cosine, cube_root, log_relative)
}
