"""Chebyshev series on [-1, 1]: smooth functions of one number, from few samples."""

import jax.numpy as jnp
import numpy as np

from brdffit.types import Scalar, Spectrum


def clenshaw(coefficients: Spectrum, x: Scalar) -> Scalar:
    """Sum of a Chebyshev series at ``x`` in [-1, 1]."""
    ahead, current = jnp.zeros_like(x), jnp.zeros_like(x)
    for n in range(coefficients.shape[0] - 1, 0, -1):
        current, ahead = 2 * x * current - ahead + coefficients[n], current
    return x * current - ahead + coefficients[0]


def nodes(count: int) -> np.ndarray:
    """Roots of the Chebyshev polynomial of degree ``count``."""
    return np.cos(np.pi * (np.arange(count) + 0.5) / count)


def transform(count: int) -> np.ndarray:
    """Matrix from values at `nodes` to the coefficients of the series through them."""
    n = np.arange(count)
    matrix = np.cos(np.pi * np.outer(n, n + 0.5) / count) * 2 / count
    matrix[0] /= 2
    return matrix
