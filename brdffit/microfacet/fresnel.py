"""Fresnel reflectance ``F(cos_d)`` of a smooth interface for unpolarised light.

``cos_d`` is the cosine between either direction and the half vector. Reflectances are
formed from ``n^2 - 1`` instead of differences of nearly equal numbers, so that they
keep their digits when the interface is weak; their derivatives are written out because
those of the quotients would cancel.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from brdffit import numerics
from brdffit.types import Direction, Scalar, Spectrum

Value = Scalar | Spectrum


def cos_d(wh: Direction) -> Scalar:
    """``wi . wh`` from the bisector ``wi + wo``: half its length."""
    return numerics.norm_of(*wh) / 2


def schlick(cos_d: Scalar, f0: Value) -> Value:
    r"""Schlick's approximation.

    $$F = F_0 + (1 - F_0)(1 - \cos\theta_d)^5$$

    Source:
        C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering",
        Computer Graphics Forum 13(3), 1994, eq. 15.
    """
    remainder = jnp.maximum(1 - cos_d, 0.0)
    square = remainder * remainder
    return f0 + (1 - f0) * (square * square * remainder)


@jax.custom_jvp
def dielectric(cos_d: Scalar, eta: Value) -> Value:
    r"""Reflectance of a dielectric with relative refractive index ``eta``.

    $$F = \tfrac12\,(r_s^2 + r_p^2), \qquad
      r_s = \frac{c - g}{c + g} = \frac{1 - \eta^2}{(c + g)^2}, \qquad
      r_p = \frac{\eta^2 c - g}{\eta^2 c + g}
          = \frac{(\eta^2 - 1)\,(c^2(\eta^2 + 1) - 1)}{(\eta^2 c + g)^2}$$

    with $c = \cos\theta_d$ and $g^2 = \eta^2 - 1 + c^2$; total reflection where that is
    negative. The derivative is infinite at the critical angle, and 0 is returned there.

    Source:
        A. Fresnel, 1823; with $c$ and $g$ in R. L. Cook and K. E. Torrance, "A
        Reflectance Model for Computer Graphics", ACM TOG 1(1), 1982.
    """
    total, _, rs, rp, _, _ = _dielectric(cos_d, eta)
    return jnp.where(total, 1.0, 0.5 * (rs * rs + rp * rp))


@dielectric.defjvp
def _dielectric_jvp(primals, tangents):
    (c, eta), (dc, deta) = primals, tangents
    total, g, rs, rp, s, p = _dielectric(c, eta)
    square, contrast = eta * eta, (eta - 1) * (eta + 1)
    by_c = 2 * contrast / g * (rs / (s * s) + rp / (p * p) * square)
    by_eta = 2 * eta * c / g * (rp / (p * p) * (square - 2 + 2 * c * c) - rs / (s * s))
    value = jnp.where(total, 1.0, 0.5 * (rs * rs + rp * rp))
    return value, jnp.where(total, 0.0, by_c) * dc + jnp.where(
        total, 0.0, by_eta
    ) * deta


def _dielectric(c: Scalar, eta: Value) -> tuple[jax.Array, ...]:
    """Whether reflection is total, ``g``, ``r_s``, ``r_p``, ``c+g``, ``eta^2 c+g``."""
    contrast = (eta - 1) * (eta + 1)
    under_root = contrast + c * c
    total = under_root <= 0
    g = numerics.sqrt(jnp.where(total, 1.0, under_root))
    s, p = c + g, eta * eta * c + g
    rs = -contrast / (s * s)
    rp = contrast * (c * c * (eta * eta + 1) - 1) / (p * p)
    return jnp.where(total & (contrast == 0), False, total), g, rs, rp, s, p


def dielectric_transmittance(cos_theta: Scalar, eta: Value) -> Value:
    r"""``1 - F`` of a dielectric with ``eta >= 1``, exact where ``F`` is close to 1.

    $$1 - F = 2r\,\Bigl(\frac{1}{(1 + r)^2} + \frac{\eta^2}{(1 + \eta^2 r)^2}\Bigr),
      \qquad r = \frac{\cos\theta}{g}$$
    """
    r = cos_theta / numerics.sqrt((eta - 1) * (eta + 1) + cos_theta * cos_theta)
    return _transmittance(r, eta)


def diffuse_transmittance(eta: Scalar) -> Scalar:
    r"""Share of diffuse light that enters a dielectric with ``eta >= 1``.

    $$T = 2\int_0^1 (1 - F)\,c\,dc$$

    by a fixed rule after $c = \sqrt{\eta^2 - 1}\,\sinh y$, which makes $r = \tanh y$
    and the integrand smooth; relative error below 1e-11. Close to ``eta = 1``, where y
    has no end, by the series of Walsh's closed form.
    """
    node, weight = (
        jnp.asarray(a, eta.dtype) for a in np.polynomial.legendre.leggauss(64)
    )
    close = eta < 1.001
    apart = jnp.where(close, 1.5, eta)
    contrast = (apart - 1) * (apart + 1)
    end = jnp.arcsinh(1 / numerics.sqrt(contrast))
    y = end * (1 + node) / 2
    share = _transmittance(jnp.tanh(y), apart) * jnp.sinh(2 * y)
    integral = contrast * end / 2 * jnp.sum(weight * share)
    return jnp.where(
        close, _transmittance_of_little(jnp.where(close, eta, 1.0)), integral
    )


def _transmittance_of_little(eta: Scalar) -> Scalar:
    """`diffuse_transmittance` for ``eta`` at most 1.001, by powers of ``eta - 1``."""
    d = eta - 1
    log = numerics.log(d)
    fifth = 0.79446158357955 + 0.625 * log
    fourth = 0.66446698784997 - 0.625 * log + fifth * d
    second = 0.44509307638669 + 0.5 * log + d * (fourth * d - 79 / 60)
    return 1 - d * (1 / 3 + second * d)


def _transmittance(r: Value, eta: Value) -> Value:
    s, p = 1 + r, 1 + eta * eta * r
    return 2 * r * (1 / (s * s) + eta * eta / (p * p))


@jax.custom_jvp
def conductor(cos_d: Scalar, eta: Value, k: Value) -> Value:
    r"""Reflectance of a conductor with complex refractive index ``eta + i k``.

    $$F = \tfrac12\,(|r_s|^2 + |r_p|^2), \qquad
      r_s = \frac{1 - n^2}{(c + q)^2}, \qquad
      r_p = \frac{(n^2 - 1)\,(c^2(n^2 + 1) - 1)}{(n^2 c + q)^2}$$

    with $n = \eta + ik$, $c = \cos\theta_d$ and $q^2 = n^2 - 1 + c^2$. With $k = 0$ it
    is `dielectric`, total reflection included.

    Source:
        M. Born and E. Wolf, *Principles of Optics*, 7th ed., section 14.2.
    """
    _, _, brewster, s, p, _, _ = _conductor(cos_d, eta, k)
    return 0.5 * (_squared(s) + _squared(p) * _squared(brewster))


@conductor.defjvp
def _conductor_jvp(primals, tangents):
    (c, eta, k), (dc, deta, dk) = primals, tangents
    n, inverse_q, brewster, s, p, to_s, to_p = _conductor(c, eta, k)
    value = 0.5 * (_squared(s) + _squared(p) * _squared(brewster))
    conjugate, square = jnp.conj(brewster), n * n
    by_c = _squared(p) * conjugate * square - _squared(s)
    by_n = to_s * jnp.conj(s) + to_p * jnp.conj(p) * conjugate * (
        square - 2 + 2 * c * c
    )
    by_c, by_n = 2 * by_c * inverse_q, 2 * c * n * inverse_q * by_n
    return value, jnp.real(by_c) * dc + jnp.real(by_n) * deta - jnp.imag(by_n) * dk


def _conductor(c: Scalar, eta: Value, k: Value) -> tuple[jax.Array, ...]:
    """Pieces that value and derivative share.

    They are ``n``, ``1/q``, ``c^2 (n^2 + 1) - 1``, ``(n^2 - 1)`` over ``|c + q|^2`` and
    over ``|n^2 c + q|^2``, and the inverses of these two.
    """
    real, imaginary = (eta - 1) * (eta + 1) - k * k, 2 * eta * k
    under_root = real + c * c
    # the larger part of q is a root, the smaller one follows from their product
    modulus = numerics.norm_of(under_root, imaginary)
    larger = numerics.sqrt(0.5 * (modulus + jnp.abs(under_root)))
    smaller = numerics.divide(eta * k, larger)
    a = jnp.where(under_root > 0, larger, smaller)
    b = jnp.where(under_root > 0, smaller, larger)
    contrast = lax.complex(real, imaginary)
    one = jnp.ones_like(a)
    to_s = numerics.divide(one, (c + a) * (c + a) + b * b)
    to_p = c * (contrast + 1) + lax.complex(a, b)
    to_p = numerics.divide(one, _squared(to_p))
    inverse_q = lax.complex(a, -b) * numerics.divide(one, a * a + b * b)
    brewster = c * c * (contrast + 2) - 1
    n = lax.complex(eta, k)
    return n, inverse_q, brewster, contrast * to_s, contrast * to_p, to_s, to_p


def _squared(x: jax.Array) -> jax.Array:
    """``|x|^2`` of a complex number."""
    return jnp.real(x) * jnp.real(x) + jnp.imag(x) * jnp.imag(x)
