r"""Masking-shadowing functions, divided by the Jacobian of the half vector.

``G(wi, wo) / (4 cos_i cos_o)`` is finite at grazing angles; ``G`` alone would leave a
0 / 0 to every model.

Smith's functions are written with the projected area of the facets that face a
direction, $A(\omega) = \int \max(0, \omega\cdot h) D(h)\,dh = \cos\theta\,(1 +
\Lambda)$, which is finite at all angles where $\Lambda$ is not. Masking alone is
$G_1(\omega) = \cos\theta / A(\omega)$. The height of a facet makes masking and
shadowing depend on each other; the separable form leaves that out.
"""

import functools

import jax
import jax.numpy as jnp
import numpy as np

from brdffit import numerics
from brdffit.geometry import bisector, cos_theta
from brdffit.microfacet import chebyshev
from brdffit.types import Direction, Scalar

TERMS = 20  # of the series for Student's t


def smith_ggx(
    wi: Direction, wo: Direction, alpha_x: Scalar, alpha_y: Scalar, separable: bool
) -> Scalar:
    """Smith masking-shadowing for GGX, over ``4 cos_i cos_o``; see `smith`."""
    area_i = area_ggx(wi, alpha_x, alpha_y)
    area_o = area_ggx(wo, alpha_x, alpha_y)
    return smith(cos_theta(wi), cos_theta(wo), area_i, area_o, separable)


def smith_beckmann(
    wi: Direction, wo: Direction, alpha_x: Scalar, alpha_y: Scalar, separable: bool
) -> Scalar:
    """Smith masking-shadowing for Beckmann, over ``4 cos_i cos_o``; see `smith`."""
    area_i = area_beckmann(wi, alpha_x, alpha_y)
    area_o = area_beckmann(wo, alpha_x, alpha_y)
    return smith(cos_theta(wi), cos_theta(wo), area_i, area_o, separable)


def smith_student_t(
    wi: Direction,
    wo: Direction,
    alpha_x: Scalar,
    alpha_y: Scalar,
    gamma: Scalar,
    separable: bool,
) -> Scalar:
    """Smith masking-shadowing for Student's t, over ``4 cos_i cos_o``; see `smith`."""
    area_i = area_student_t(wi, alpha_x, alpha_y, gamma)
    area_o = area_student_t(wo, alpha_x, alpha_y, gamma)
    return smith(cos_theta(wi), cos_theta(wo), area_i, area_o, separable)


def smith(
    cos_i: Scalar, cos_o: Scalar, area_i: Scalar, area_o: Scalar, separable: bool
) -> Scalar:
    r"""Smith masking-shadowing from projected areas, over $4\cos_i\cos_o$.

    $$\frac{G}{4\cos_i\cos_o} = \frac{1}{4\cos_i\cos_o\,(1 + \Lambda_i + \Lambda_o)}
      = \frac{1}{4\,(A_i\cos_o + A_o\cos_i - \cos_i\cos_o)}$$

    and $1 / (4 A_i A_o)$ when separable.

    Source:
        E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
        BRDFs", JCGT 3(2), 2014, eq. 98 (separable) and 99.
    """
    if separable:
        return 0.25 / (area_i * area_o)
    return 0.25 / (area_i * cos_o + (area_o - cos_o) * cos_i)


def area_ggx(w: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""Projected area of GGX facets that face ``w``.

    $$A = \tfrac12\Bigl(z + \sqrt{(\alpha_x x)^2 + (\alpha_y y)^2 + z^2}\Bigr)$$

    Source:
        E. Heitz, JCGT 3(2), 2014, eq. 72, stretched along both axes.
    """
    x, y, z = w
    return 0.5 * (z + numerics.norm_of(alpha_x * x, alpha_y * y, z))


def area_beckmann(w: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""Projected area of Beckmann facets that face ``w``.

    $$A = \tfrac12\Bigl(z\,(1 + \mathrm{erf}(z/t))
          + \frac{t}{\sqrt\pi}\,e^{-(z/t)^2}\Bigr),
      \qquad t = \sqrt{(\alpha_x x)^2 + (\alpha_y y)^2}$$

    Source:
        E. Heitz, JCGT 3(2), 2014, section 5.2, stretched along both axes.
    """
    x, y, z = w
    return _area_beckmann(z, numerics.norm_of(alpha_x * x, alpha_y * y))


@jax.custom_jvp
def _area_beckmann(z: Scalar, t: Scalar) -> Scalar:
    smooth, erf, bell = _bell(z, t)
    return jnp.where(smooth, z, 0.5 * (z * (1 + erf) + t * bell))


@_area_beckmann.defjvp
def _area_beckmann_jvp(primals, tangents):
    # by hand: the derivatives of erf and of the bell cancel, which autodiff cannot see
    (z, t), (dz, dt) = primals, tangents
    _, erf, bell = _bell(z, t)
    return _area_beckmann(z, t), 0.5 * ((1 + erf) * dz + bell * dt)


def _bell(z: Scalar, t: Scalar) -> tuple[jax.Array, ...]:
    """Whether all facets face ``w``, ``erf(z/t)`` and ``exp(-(z/t)^2)/sqrt(pi)``."""
    smooth = 20 * t < z
    cotangent = jnp.where(smooth, 20.0, z / jnp.where(smooth, 1.0, t))
    bell = jnp.exp(-cotangent * cotangent) / numerics.SQRT_PI
    return smooth, jax.lax.erf(cotangent), bell


def area_beckmann_rational(w: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""Rational approximation of `area_beckmann`, as many renderers have it.

    With $b = z/t$ masking is $G_1 = (3.535 b + 2.181 b^2) / (1 + 2.276 b + 2.577 b^2)$
    below $b = 1.6$ and 1 above. Largest error of $G_1$: 0.31 %, at $b = 1.34$; it is
    0.9972 of the truth towards grazing and jumps by 6e-5 at $b = 1.6$.

    Source:
        B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces",
        EGSR 2007, eq. 27.
    """
    x, y, z = w
    t = numerics.norm_of(alpha_x * x, alpha_y * y)
    rough = (t * t + 2.276 * z * t + 2.577 * z * z) / (3.535 * t + 2.181 * z)
    return jnp.where(z < 1.6 * t, rough, z)


def area_student_t(
    w: Direction, alpha_x: Scalar, alpha_y: Scalar, gamma: Scalar
) -> Scalar:
    r"""Projected area of facets whose slopes follow Student's t, ``gamma > 3/2``.

    Slopes along the direction of ``w`` have the density $p(s) = C\,(1 + s^2/(\gamma -
    1))^{1/2-\gamma}$ in units of alpha, so that

    $$A = z \int_{-\infty}^{z/t} p(s)\,ds + t \int_{z/t}^\infty s\,p(s)\,ds, \qquad
      t = \sqrt{(\alpha_x x)^2 + (\alpha_y y)^2}$$

    The second integral has a closed form. The first is 1 less
    $C' c^{m+1} \int_0^1 g^m (1 - c^2 g^2)^{-1/2}\,dg$ with $m = 2\gamma - 3$ and
    $c^2 = t^2(\gamma - 1) / (z^2 + t^2(\gamma - 1))$, by a Chebyshev series in
    $\sqrt{1 - c^2}$: relative error of $A$ below 2e-8 for $1.51 \le \gamma \le 40$. At
    $\gamma \le 3/2$ the area is infinite.

    Source:
        Derived here from the definition of the area, with the density of M.
        Ribardiere et al., "STD: Student's t-Distribution of Slopes for Microfacet
        Based BSDFs", Computer Graphics Forum 36(2), 2017.
    """
    x, y, z = w
    return _area_student_t(z, numerics.norm_of(alpha_x * x, alpha_y * y), gamma)


@jax.custom_jvp
def _area_student_t(z: Scalar, t: Scalar, gamma: Scalar) -> Scalar:
    facing, beyond = _student_t(z, t, gamma)
    return z * facing + t * beyond


@_area_student_t.defjvp
def _area_student_t_jvp(primals, tangents):
    # the integrals are the derivatives by z and t; autodiff would cancel two terms
    (z, t, gamma), (dz, dt, dgamma) = primals, tangents
    (facing, beyond), (by_gamma, beyond_by_gamma) = jax.jvp(
        lambda gamma: _student_t(z, t, gamma), (gamma,), (dgamma,)
    )
    tangent = facing * dz + beyond * dt + (z * by_gamma + t * beyond_by_gamma)
    return z * facing + t * beyond, tangent


def _student_t(z: Scalar, t: Scalar, gamma: Scalar) -> tuple[Scalar, Scalar]:
    """The two integrals of `area_student_t`."""
    nodes, grazing, to_series = (jnp.asarray(a, z.dtype) for a in _tail_integral())
    scale, power = numerics.sqrt(gamma - 1), 2 * gamma - 3
    moments = jnp.exp(power * jnp.log(nodes))
    # at grazing the first integral is 1/2, which gives C'
    constant = 0.5 / (grazing @ moments)
    length = numerics.norm_of(z, t * scale)
    cosine, sine = t * scale / length, z / length
    tail = constant * numerics.pow(cosine, power)
    away = chebyshev.clenshaw(to_series @ moments, 2 * sine - 1)
    return 1 - tail * cosine * away, tail * scale / power


@functools.cache
def _tail_integral() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    r"""Nodes ``g`` in (0, 1), and what makes the integral from the powers $g^m$.

    A row for $c = 1$, and the matrix to its Chebyshev series in $\sqrt{1 - c^2}$. The
    rule is double-exponential, for the roots at both ends.
    """
    tau, step = np.linspace(-2.4, 3.2, 40, retstep=True)
    stretched = np.exp(-np.pi * np.sinh(tau))
    node, rest = 1 / (1 + stretched), stretched / (1 + stretched)
    weight, complement = step * np.pi * np.cosh(tau) * node * rest, rest * (1 + node)
    square = (0.5 + 0.5 * chebyshev.nodes(TERMS)[:, None]) ** 2
    values = weight / np.sqrt(square + (1 - square) * complement)
    return node, weight / np.sqrt(complement), chebyshev.transform(TERMS) @ values


def v_cavity(wi: Direction, wo: Direction) -> Scalar:
    r"""Masking-shadowing of symmetric V-shaped grooves, over $4\cos_i\cos_o$.

    $$G = \min\Bigl(1,\;
          \frac{2\cos\theta_h\cos\theta_o}{\cos\theta_d},\;
          \frac{2\cos\theta_h\cos\theta_i}{\cos\theta_d}\Bigr)$$

    With $H = \omega_i + \omega_o$ the last two become
    $H_z / (|H|^2\max(\cos_i, \cos_o))$ after the division.

    Source:
        K. Torrance and E. Sparrow, "Theory for Off-Specular Reflection From Roughened
        Surfaces", JOSA 57(9), 1967; in this form R. Cook and K. Torrance, "A
        Reflectance Model for Computer Graphics", ACM TOG 1(1), 1982.
    """
    cos_i, cos_o = cos_theta(wi), cos_theta(wo)
    wh = bisector(wi, wo)
    length = numerics.norm_of(*wh)
    # two divisions by the length: one by its square overflows in the gradient
    blocked = wh[2] / length / (length * jnp.maximum(cos_i, cos_o))
    return jnp.minimum(0.25 / (cos_i * cos_o), blocked)
