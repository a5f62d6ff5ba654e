"""Elementary functions whose values *and* gradients are finite everywhere.

The only module that may call ``jnp.sqrt``, ``jnp.arccos``, ``jnp.power`` or
``jnp.linalg.norm`` (``tests/test_architecture.py`` checks this). Each function
replaces the argument before the singular operation, because ``jnp.where`` after it
would still multiply an infinite derivative by zero and return NaN.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

Real = Float[Array, "..."]

# of log(1 + x) / x, highest power first
LOG1P_SERIES = tuple((-1) ** n / (n + 1) for n in reversed(range(11)))
# of arctan(x) / x in powers of x^2, highest first
ARCTAN_SERIES = tuple((-1) ** n / (2 * n + 1) for n in reversed(range(20)))

SQRT_PI = 1.7724538509055159


def sqrt(x: Real) -> Real:
    """``sqrt(max(x, 0))``; the derivative is 0 for ``x <= 0``."""
    positive = x > 0
    return jnp.where(positive, jnp.sqrt(jnp.where(positive, x, 1.0)), 0.0)


def arccos(x: Real) -> Real:
    """``arccos(clip(x, -1, 1))``; the derivative is 0 for ``|x| >= 1``."""
    inside = jnp.abs(x) < 1
    edge = jnp.where(x > 0, 0.0, jnp.pi)
    return jnp.where(inside, jnp.arccos(jnp.where(inside, x, 0.0)), edge)


def arctan2(y: Real, x: Real) -> Real:
    """``arctan2(y, x)``, and 0 with derivative 0 at the origin."""
    origin = (x == 0) & (y == 0)
    return jnp.where(origin, 0.0, jnp.arctan2(y, jnp.where(origin, 1.0, x)))


def divide(x: Real, y: Real) -> Real:
    """``x / y``, and 0 where ``y == 0``."""
    nonzero = y != 0
    return jnp.where(nonzero, x / jnp.where(nonzero, y, 1.0), 0.0)


def log(x: Real) -> Real:
    """``log(x)``, and a large negative number with derivative 0 where ``x <= 0``."""
    smallest = jnp.finfo(x.dtype).tiny
    positive = x > smallest
    return jnp.where(positive, jnp.log(jnp.where(positive, x, 1.0)), jnp.log(smallest))


def pow(x: Real, exponent: Real) -> Real:
    """``x**exponent`` for ``x >= 0``, and 0 where ``x <= 0`` (also for exponent 0)."""
    positive = x > 0
    power = jnp.exp(exponent * jnp.log(jnp.where(positive, x, 1.0)))
    return jnp.where(positive, power, 0.0)


def pow_near_one(x: Real, deficit: Real, exponent: Real) -> Real:
    """``x**exponent``, and 0 where ``x <= 0``, exponent 0 included.

    A high power of a number close to 1 keeps all its digits when that number is given
    by its distance from 1 as well, ``deficit = 1 - x``. Far from 1 it is ``x`` that has
    the digits; one smaller than the rounding of a cosine may be 0, and counts as 0.
    """
    positive, near = x > jnp.finfo(x.dtype).eps / 2, jnp.abs(deficit) < 0.5
    apart = jnp.log(jnp.where(positive & ~near, x, 1.0))
    power = exponent * (apart + jnp.log1p(-jnp.where(near, deficit, 0.0)))
    largest = 0.9 * jnp.log(jnp.finfo(x.dtype).max)
    return jnp.where(positive, jnp.exp(jnp.minimum(power, largest)), 0.0)


def log1p_ratio(x: Real) -> Real:
    """``log(1 + x) / x`` for ``x > -1``, and 1 at 0, where the quotient is 0 / 0."""
    small = jnp.abs(x) < 0.03
    near, series = jnp.where(small, x, 0.0), jnp.zeros_like(x)
    for coefficient in LOG1P_SERIES:
        series = series * near + coefficient
    apart = jnp.where(small, 1.0, x)
    return jnp.where(small, series, jnp.log1p(apart) / apart)


def log_ratio(x: Real) -> Real:
    """``log(x) / (x - 1)`` for ``x > 0``, and 1 at 1, where the quotient is 0 / 0.

    Differs from `log1p_ratio` in what is exact: here ``x``, also where it is tiny.
    """
    close = jnp.abs(x - 1) < 0.03
    apart = jnp.where(close, 2.0, x)
    near = log1p_ratio(jnp.where(close, x - 1, 0.0))
    return jnp.where(close, near, jnp.log(apart) / (apart - 1))


def angle_ratio(sine: Real, cosine: Real) -> Real:
    """Angle over its sine for a point of the unit circle with ``cosine >= 0``.

    By the tangent of a quarter of the angle: neither 0 / 0 at the angle 0 nor an
    infinite derivative at a right angle, and several times faster than ``arctan2``.
    """
    half = sine / (1 + cosine)
    root = 1 + sqrt(1 + half * half)
    square, series = (half / root) ** 2, jnp.zeros_like(sine)
    for coefficient in ARCTAN_SERIES:
        series = series * square + coefficient
    return 4 * series / ((1 + cosine) * root)


def cbrt(x: Real) -> Real:
    """Cube root of ``x >= 0``; 0 with derivative 0 where ``x <= 0``."""
    positive = x > 0
    return jnp.where(positive, jnp.cbrt(jnp.where(positive, x, 1.0)), 0.0)


def norm_of(first: Real, *others: Real) -> Real:
    """``sqrt`` of the sum of squares; the derivative is 0 where all are zero."""
    total = first * first
    for component in others:
        total = total + component * component
    return sqrt(total)


def norm(v: Float[Array, " n"]) -> Float[Array, ""]:
    """Length of ``v``; the derivative is 0 for the zero vector."""
    return sqrt(jnp.sum(v * v))


def normalize(v: Float[Array, " n"]) -> Float[Array, " n"]:
    """``v / |v|``, and the zero vector for ``v == 0``."""
    return divide(v, norm(v) * jnp.ones_like(v))
