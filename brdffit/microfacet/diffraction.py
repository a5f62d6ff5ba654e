r"""Light as a wave on a rough surface: how rough it looks, and how far it scatters.

The surface has heights of standard deviation ``sigma0`` and slopes of standard
deviation ``sqrt(2) sigma0 / tau``. What is seen at grazing angles are its hills alone,
which are less rough; how much rougher than the wavelength they are decides between a
mirror image and a lobe.
"""

import functools
import math
from collections.abc import Sequence

import jax
import jax.numpy as jnp
import numpy as np

from brdffit import numerics
from brdffit.types import Direction, Scalar

STEPS = 6  # of Newton's method for W, from starts that make these enough in float64
NODES = {np.dtype(np.float32): 68, np.dtype(np.float64): 168}
SPREAD = {np.dtype(np.float32): 5.6, np.dtype(np.float64): 8.6}
ARTANH_SERIES = tuple(1 / (2 * n + 3) for n in range(16))
EXPM1_SERIES = tuple(1 / math.factorial(n + 2) for n in range(13))
# of these two where the argument of the first is at most 1/9, of the second 1/2
SERIES_TERMS = {np.dtype(np.float32): (7, 6), np.dtype(np.float64): (16, 13)}
STIRLING_TERMS = {np.dtype(np.float32): 8, np.dtype(np.float64): 18}


def effective_roughness(
    wi: Direction, wo: Direction, sigma0: Scalar, tau: Scalar
) -> Scalar:
    r"""Standard deviation of the heights that are both lit and seen.

    $$\sigma = \frac{\sigma_0}{\sqrt{1 + W}}, \qquad
      W e^W = \frac{(K_i + K_o)^2}{8\pi}, \qquad
      K = \tan\theta\;\mathrm{erfc}\frac{\tau\cot\theta}{2\sigma_0}$$

    $W$ is $(z_0/\sigma_0)^2$ of the paper.

    Source:
        X. He et al., "A Comprehensive Physical Model for Light Reflection", SIGGRAPH
        1991, eq. 80-83.
    """
    rises = [_rise(w, sigma0, tau) for w in (wi, wo)]
    f = sum(rises) / numerics.sqrt(jnp.full_like(sigma0, 8 * jnp.pi))
    return sigma0 / numerics.sqrt(1 + lambert_w_of_square(f))


def lit_share(w: Direction, sigma0: Scalar, tau: Scalar) -> Scalar:
    """``1 - erfc(x) / 2``: share of the slopes that do not face away from ``w``."""
    return 0.5 * jax.lax.erfc(-_cotangent(w, sigma0, tau))


def _rise(w: Direction, sigma0: Scalar, tau: Scalar) -> Scalar:
    x, y, z = w
    return numerics.norm_of(x, y) / z * jax.lax.erfc(_cotangent(w, sigma0, tau))


def _cotangent(w: Direction, sigma0: Scalar, tau: Scalar) -> Scalar:
    """``tau cot(theta) / (2 sigma0)``, at most 20."""
    x, y, z = w
    width = 2 * sigma0 / tau * numerics.norm_of(x, y)
    smooth = 20 * width < z
    return jnp.where(smooth, 20.0, z / jnp.where(smooth, 1.0, width))


@jax.custom_jvp
def lambert_w_of_square(f: Scalar) -> Scalar:
    """``W0(f^2)`` for ``f >= 0``: the ``y`` with ``y exp(y) = f^2``."""
    small = f < 1
    low, high = jnp.where(small, f, 0.5), jnp.where(small, 2.0, f)
    y = low * low / (1 + low * low)
    for _ in range(STEPS):
        # Newton on y - f^2 exp(-y)
        right = low * low * jnp.exp(-y)
        y = y - (y - right) / (1 + right)
    target = 2 * jnp.log(high)
    z = jnp.maximum(target - jnp.log(1 + target), 0.5)
    for _ in range(STEPS):
        # Newton on z + log(z) - log(f^2)
        z = z * (1 + target - jnp.log(z)) / (1 + z)
    return jnp.where(small, y, z)


@lambert_w_of_square.defjvp
def _lambert_w_jvp(primals, tangents):
    (f,), (df,) = primals, tangents
    y = lambert_w_of_square(f)
    small = f < 1
    ratio = jnp.where(small, f * jnp.exp(-y), y / jnp.where(small, 1.0, f))
    return y, 2 * ratio / (1 + y) * df


@jax.custom_jvp
def scattering_lobe(g: Scalar, t: Scalar) -> Scalar:
    r"""Light in all orders of scattering, those of high order rarer and wider.

    $$L = (1 + g) \sum_{m=1}^\infty \frac{g^m e^{-g}}{m!\,m}\,e^{-c/m},
      \qquad c = (1 + g)\,t$$

    $g e^{-t}$ on a smooth surface and $e^{-t}$ on a rough one, the Gaussian of its
    slopes: scaled so, it hardly depends on $g$ where light has no wavelength.

    The largest term is at $m = g\,e^{W/2}$ with $W e^W = 2c/g^2$. Around it the terms
    fall like a Gaussian of known width. All orders within some widths are added where
    these are few; otherwise every second, third or further one, which changes a sum of
    such terms by less than rounding. Powers and factorials enter as the exponent
    $m\,(x - \log(1 + x)) + \psi(m)$, $x = (g - m)/m$, which does not cancel.

    Source:
        The sum of X. He et al., SIGGRAPH 1991, eq. 78; its exponents as in C. Loader,
        "Fast and Accurate Computation of Binomial Probabilities", 2000.
    """
    return (1 + g) * _sums(g, t, slopes=False)[0]


@scattering_lobe.defjvp
def _scattering_lobe_jvp(primals, tangents):
    # by hand: each term of the derivative is one of the sum times a simple factor
    (g, t), (dg, dt) = primals, tangents
    total, by_g, by_t = _sums(g, t, slopes=True)
    return (1 + g) * total, by_g * dg + by_t * (1 + g) * (1 + g) * dt


def _sums(g: Scalar, t: Scalar, slopes: bool) -> tuple[Scalar, Scalar, Scalar]:
    """The series, the derivative of the lobe by ``g``, that of the series by ``c``.

    One order after another: an array of all orders of all directions would not fit in
    a cache. Without ``slopes`` the derivatives are 0.
    """
    dtype, c = g.dtype, (1 + g) * t
    g = jnp.maximum(g, jnp.finfo(dtype).tiny ** 0.5)
    low, step = _orders(g, c)

    def add(index, sums):
        m = low + step * index
        u = 1 / m
        x = (g - m) * u
        v = x / (2 + x)
        deviance = jnp.where(
            jnp.abs(x) < 0.1,
            v * (x - 2 * v * v * _horner(ARTANH_SERIES[:7], v * v)),
            x - jnp.log(g * u),
        )
        psi = u * _horner(stirling_series(dtype), 2 * u - 1)
        term = jnp.exp(-(m * deviance + c * u + psi)) * u * numerics.sqrt(u)
        total, by_g, by_c = sums
        if slopes:
            step_down, bend = _previous_order(u, c)
            by_g, by_c = by_g - term * m * (bend + step_down / g), by_c - term * u
        return total + term, by_g, by_c

    zero = jnp.zeros_like(g)
    sums = jax.lax.fori_loop(0, NODES[dtype], add, (zero, zero, zero))
    scale = step / np.sqrt(2 * np.pi).astype(dtype)
    return sums[0] * scale, sums[1] * scale, sums[2] * scale


def _previous_order(u: Scalar, c: Scalar) -> tuple[Scalar, Scalar]:
    r"""How ``h = exp(-c/m) / m`` changes from order ``m = 1/u`` to the one before.

    Returns $h(m - 1)/h(m) - 1$, and that plus $h'(m)/h(m)$, which is small at high
    orders. With Poisson's $m p_m = g p_{m-1}$ they give the derivatives of the series
    $S$ by sums of terms that do not cancel:

    $$g S_g = -\sum m\,p_m\,(h(m - 1) - h(m)), \qquad
      S + g S_g + c S_c = -\sum m\,p_m\,(h(m - 1) - h(m) + h'(m))$$
    """
    artanh, expm1 = SERIES_TERMS[u.dtype]
    first = u >= 1
    u = jnp.where(first, 0.5, u)
    v = u / (2 - u)  # the logarithm of 1 - u is -2 artanh(v)
    excess = v * (u + 2 * v * v * _horner(ARTANH_SERIES[:artanh], v * v))
    slope, rest = u - c * u * u, excess - c * u * u * u / (1 - u)
    logarithm = slope + rest
    close = jnp.abs(logarithm) < 0.5
    near = jnp.where(close, logarithm, 0.0)
    curved = jnp.where(
        close,
        near * near * _horner(EXPM1_SERIES[:expm1], near),
        jnp.exp(logarithm) - 1 - logarithm,
    )
    # nothing comes before the first order
    change = jnp.where(first, -1.0, logarithm + curved)
    return change, jnp.where(first, c - 2, curved + rest)


def _orders(g: Scalar, c: Scalar) -> tuple[Scalar, Scalar]:
    """Lowest order to add up, and the distance to the next."""
    count, spread = NODES[g.dtype], SPREAD[g.dtype]
    w = lambert_w_of_square(numerics.sqrt(2 * c) / g)
    peak = jnp.maximum(g * jnp.exp(0.5 * w), 1.0)
    width = numerics.sqrt(peak / (1 + 2 * c / (peak * peak)))
    low = jnp.maximum(jnp.floor(peak - spread * width), 1.0)
    # terms lean to higher orders, by the third derivative of their logarithm
    high = peak + spread * width + spread * spread / 5
    # whole numbers, which are exact
    step = jnp.maximum(jnp.ceil((high - low) / (count - 1)), 1.0)
    return low, step


def _horner(coefficients: Sequence[float], x: Scalar) -> Scalar:
    """Polynomial with these coefficients, the constant first."""
    total = jnp.zeros_like(x)
    for coefficient in reversed(coefficients):
        total = total * x + coefficient
    return total


@functools.cache
def stirling_series(dtype: np.dtype) -> tuple[float, ...]:
    r"""Polynomial in $2/m - 1$ for $m\,\psi(m)$, $m \ge 1$.

    $\psi(m) = \log m! - (m + \frac12)\log m + m - \frac12\log 2\pi$ is the error of
    Stirling's formula. From its recurrence upwards to where it is its own series.
    """
    count = STIRLING_TERMS[np.dtype(dtype)]
    node = np.cos(np.pi * (np.arange(40) + 0.5) / 40)
    m = 2 / (1 + node)
    psi = np.zeros_like(m)
    for n in range(20):
        # (m + 1/2) log(1 + 1/m) - 1, in powers of 1 / (2m + 1)
        t = 1 / (2 * (m + n) + 1)
        psi += sum(t ** (2 * k) / (2 * k + 1) for k in range(1, 17))
    top = m + 20
    series = ((1, 12), (-1, 360), (1, 1260), (-1, 1680), (1, 1188))
    psi += sum(s / (k * top ** (2 * n + 1)) for n, (s, k) in enumerate(series))
    fitted = np.polynomial.chebyshev.chebfit(node, m * psi, 39)[:count]
    return tuple(np.polynomial.chebyshev.cheb2poly(fitted).tolist())
