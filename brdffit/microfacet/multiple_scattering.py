r"""Energy that GGX facets lose to a second reflection, and a lobe that gives it back.

Light that strikes a second facet is missing from the single-scattering lobe. What is
missing for $F = 1$, $\bar\epsilon(\mu) = 1 - E(\mu)$, has no closed form. It is
tabulated when first asked for, from the integral of its definition (`missing`), as

$$1 - E = \frac{\mu R}{2}\log\Bigl(1 + \frac{\alpha^2}{\mu^2}\Bigr)
          + \frac{x}{(1 + x^2)^{3/2}}\;T(t, a), \qquad
  R = \sqrt{\mu^2 + \alpha^2(1 - \mu^2)}, \quad x = \mu/\alpha$$

The first term takes away the logarithm at grazing, the second factor the decay towards
the normal. What remains is analytic in $a = \mathrm{arsinh}(1/\alpha)$ and
$t = \mathrm{arsinh}(x)/a$, and a Chebyshev series of it converges to 1e-12 of $1 - E$.
"""

import functools

import jax.numpy as jnp
import numpy as np

from brdffit import numerics
from brdffit.microfacet import chebyshev
from brdffit.types import Direction, Scalar, Spectrum

ALPHA = (9e-5, 1.02)  # of the table, a little more than models allow
TERMS = {np.dtype(np.float32): (36, 30), np.dtype(np.float64): (80, 60)}
FRESNEL_MEAN = 1 / 21  # of (1 - cos)^5 over the hemisphere


def kulla_conty(wi: Direction, wo: Direction, f0: Spectrum, alpha: Scalar) -> Spectrum:
    r"""Light reflected more than once by GGX facets with Schlick's Fresnel factor.

    $$f_{ms} = \frac{\bar F^2 \bar E}{1 - \bar F (1 - \bar E)}\,
               \frac{(1 - E(\omega_i))(1 - E(\omega_o))}{\pi\,(1 - \bar E)}, \qquad
      \bar F = F_0 + \frac{1 - F_0}{21}$$

    Source:
        C. Kulla and A. Conty, "Revisiting Physically Based Shading at Imageworks",
        SIGGRAPH 2017 course notes. The colour factor is that of S. Hill, "A Multi-
        Faceted Exploration", 2018, part 3; the notes have one $\bar F$ less.
    """
    average = average_missing_albedo(alpha)
    lost = missing_albedo(wi[2], alpha) * missing_albedo(wo[2], alpha) / average
    fresnel = f0 + (1 - f0) * FRESNEL_MEAN
    colour = fresnel * fresnel * (1 - average) / (1 - fresnel * average)
    return colour * (lost / jnp.pi)


def missing_albedo(cos_theta: Scalar, alpha: Scalar) -> Scalar:
    """``1 - E``: what single scattering with F = 1 loses of light from one direction.

    Masking is Smith's, correlated with height. Relative error below 1e-11, or what the
    precision of the numbers allows, for alpha from 1e-4 to 1.
    """
    series, _ = table(cos_theta.dtype)
    a, basis = roughness_basis(alpha, series.shape[1])
    x = jnp.maximum(cos_theta / alpha, 1e-18)
    smooth = chebyshev.clenshaw(jnp.asarray(series) @ basis, 2 * jnp.arcsinh(x) / a - 1)
    sine_squared = (1 - cos_theta) * (1 + cos_theta)
    r = numerics.sqrt(cos_theta * cos_theta + alpha * alpha * sine_squared)
    grazing = 0.5 * cos_theta * r * jnp.log1p(1 / x / x)
    cosine_squared = 1 / (1 + x * x)
    return grazing + x * cosine_squared * numerics.sqrt(cosine_squared) * smooth


def average_missing_albedo(alpha: Scalar) -> Scalar:
    """``1 - E`` averaged over diffuse light; error as that of `missing_albedo`."""
    _, series = table(alpha.dtype)
    _, basis = roughness_basis(alpha, series.shape[0])
    return alpha * alpha * jnp.exp(jnp.asarray(series) @ basis)


def roughness_basis(alpha: Scalar, count: int) -> tuple[Scalar, Spectrum]:
    """``arsinh(1 / alpha)`` and Chebyshev polynomials of it, scaled to the table."""
    high, low = np.arcsinh(1 / np.array(ALPHA))
    a = jnp.arcsinh(1 / alpha)
    angle = numerics.arccos((2 * a - (high + low)) / (high - low))
    return a, jnp.cos(np.arange(count) * angle)


@functools.cache
def table(dtype: np.dtype) -> tuple[np.ndarray, np.ndarray]:
    """Chebyshev series of ``T(t, a)`` and of ``log((1 - mean E) / alpha^2)``."""
    count_t, count_a = TERMS[np.dtype(np.float64)]
    high, low = np.arcsinh(1 / np.array(ALPHA))
    t = (1 + chebyshev.nodes(count_t)) / 2
    a = (high + low) / 2 + (high - low) / 2 * chebyshev.nodes(count_a)
    alpha, x = 1 / np.sinh(a), np.sinh(t[:, None] * a)
    mu = alpha * x
    r = np.sqrt(mu**2 + alpha**2 * (1 - mu**2))
    smooth = missing(mu, alpha) - mu * r / 2 * np.log1p(1 / x**2)
    smooth *= (1 + x**2) ** 1.5 / x
    node, weight = np.polynomial.legendre.leggauss(96)
    t = (1 + node[:, None]) / 2
    mu = alpha * np.sinh(t * a)
    average = np.sum(
        weight[:, None] * missing(mu, alpha) * mu * alpha * np.cosh(t * a) * a, axis=0
    )
    to_t, to_a = (chebyshev.transform(count) for count in (count_t, count_a))
    terms_t, terms_a = TERMS[np.dtype(dtype)]
    series = (to_t @ smooth @ to_a.T)[:terms_t, :terms_a]
    means = (to_a @ np.log(average / alpha**2))[:terms_a]
    return series.astype(dtype), means.astype(dtype)


def missing(mu: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    r"""``1 - E`` by quadrature, without the cancellation of its name.

    $G_1(\omega_o)$ instead of $G$ in the lobe would make its integral over all
    directions, those below the horizon included, exactly 1. So $1 - E$ is the integral
    of the lobe with $G_1 - G$ above the horizon and with $G_1$ below. That over azimuth
    is closed; the one over $\theta_i$ is taken in three pieces by Gauss-Legendre rules,
    each in the variable that makes it smooth: the mirror direction of width alpha, the
    horizon of width alpha or mu, and what is below.
    """
    mu, alpha = mu[..., None], alpha[..., None]
    s = np.sqrt((1 - mu) * (1 + mu))
    node, weight = np.polynomial.legendre.leggauss(96)

    def stretched(low, high):
        return low + (high - low) * (1 + node) / 2, (high - low) / 2 * weight

    def about_mirror(low, high, above):
        y, dy = stretched(np.arcsinh(low / alpha), np.arcsinh(high / alpha))
        u, du = alpha * np.sinh(y), alpha * np.cosh(y) * dy
        cosine, sine = (1 - u) * (1 + u) / (1 + u * u), 2 * u / (1 + u * u)
        mu_i, s_i = mu * cosine - s * sine, s * cosine + mu * sine
        d_mu = 2 * s_i * du / (1 + u * u)
        return np.sum(missing_density(mu, mu_i, s, s_i, u, alpha, above) * d_mu, -1)

    def about_horizon(mu_i, d_mu):
        s_i = np.sqrt(np.maximum((1 - mu_i) * (1 + mu_i), 0))
        u = (mu - mu_i) / (s_i + s)
        return np.sum(missing_density(mu, mu_i, s, s_i, u, alpha, True) * d_mu, -1)

    middle = mu / 2
    turn = (mu - middle) / (np.sqrt(1 - middle**2) + s)
    y, dy = stretched(0, np.arcsinh(middle / alpha))
    steep = about_mirror(-s / (1 + mu), turn, True) + about_horizon(
        alpha * np.sinh(y), alpha * np.cosh(y) * dy
    )
    y, dy = stretched(0, np.log1p(1 / mu))
    grazing = about_horizon(mu * np.expm1(y), mu * np.exp(y) * dy)
    below = about_mirror(mu / (1 + s), mu / s, False)
    return below + np.where((mu < alpha)[..., 0], grazing, steep)


def missing_density(mu, mu_i, s, s_i, u, alpha, above):
    r"""Integrand of `missing` over $\mu_i$, integrated over azimuth.

    With $u = \tan\frac{\theta_i - \theta_o}{2}$, $v = \tan\frac{\theta_i +
    \theta_o}{2}$, $p = u^2 + \alpha^2$, $q = v^2 + \alpha^2$ and $k = 1 - \alpha^2$

    $$\frac{\alpha^2}{2\mu}\Bigl(1 + \frac{2k}{\sqrt{pq}}
      + \frac{k^2\,(p + q)}{2\,(pq)^{3/2}}\Bigr)\,(G_1 - G)$$
    """
    k = (1 - alpha) * (1 + alpha)
    v = (s_i + s) / (mu_i + mu)
    p, q = u * u + alpha * alpha, v * v + alpha * alpha
    facets = 1 + 2 * k / np.sqrt(p * q) + k * k * (p + q) / (2 * (p * q) ** 1.5)
    r = np.sqrt(mu**2 + (alpha * s) ** 2)
    masked = 2 * mu / (mu + r)
    if above:
        r_i = np.sqrt(mu_i**2 + (alpha * s_i) ** 2)
        masked = (
            masked * mu * (alpha * s_i) ** 2 / ((r_i + mu_i) * (mu * r_i + mu_i * r))
        )
    return alpha**2 / (2 * mu) * facets * masked
