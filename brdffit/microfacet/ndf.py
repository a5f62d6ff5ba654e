r"""Normal distribution functions ``D``, in 1/sr, of a bisector of any length.

Only the slopes of ``wh`` and its direction matter, so the unnormalised ``wi + wo``
serves: it is exact near the mirror direction. All are normalised to
$\int D \cos\theta_h\,d\omega_h = 1$ over the hemisphere.
"""

import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import tan_squared
from brdffit.types import Direction, Scalar


def beckmann(wh: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""Beckmann: slopes with a normal distribution.

    $$D = \frac{1}{\pi\,\alpha_x\alpha_y\cos^4\theta_h}\,\exp\Bigl(
          -\frac{(h_x/\alpha_x)^2 + (h_y/\alpha_y)^2}{h_z^2}\Bigr)$$

    The fourth power goes into the exponent, as $2\log(1 + \tan^2\theta_h)$.

    Source:
        P. Beckmann and A. Spizzichino, *The Scattering of Electromagnetic Waves from
        Rough Surfaces*, 1963; in this form B. Walter et al., "Microfacet Models for
        Refraction through Rough Surfaces", EGSR 2007, eq. 25.
    """
    x, y, z = wh
    u, v = x / z, y / z
    a, b = u / alpha_x, v / alpha_y
    exponent = 2 * jnp.log1p(u * u + v * v) - (a * a + b * b)
    return jnp.exp(exponent) / (jnp.pi * alpha_x * alpha_y)


def slope_gaussian(wh: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""Gaussian of the slopes of ``wh``, 1 at the normal: the lobe of Ward's models.

    $$E = \exp\Bigl(-\frac{(h_x/\alpha_x)^2 + (h_y/\alpha_y)^2}{h_z^2}\Bigr)$$
    """
    x, y, z = wh
    u, v = x / (z * alpha_x), y / (z * alpha_y)
    return jnp.exp(-(u * u + v * v))


def ggx(wh: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""GGX (Trowbridge-Reitz): tails longer than Beckmann's.

    $$D = \frac{1}{\pi\,\alpha_x\alpha_y\,\bigl((h_x/\alpha_x)^2 + (h_y/\alpha_y)^2
          + h_z^2\bigr)^2}$$

    Source:
        B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces",
        EGSR 2007, eq. 33.
    """
    x, y, z = wh
    scale = 1 / numerics.norm_of(x, y, z)
    u, v = x * scale, y * scale
    # without h_z^2, whose gradient would cancel that of the length near the normal
    q = 1 / (1 + u * u * _excess(alpha_x) + v * v * _excess(alpha_y))
    return q * q / (jnp.pi * alpha_x * alpha_y)


def _excess(alpha: Scalar) -> Scalar:
    """``1/alpha^2 - 1``."""
    return (1 - alpha) * (1 + alpha) / (alpha * alpha)


def gtr1(wh: Direction, alpha: Scalar) -> Scalar:
    r"""Generalised Trowbridge-Reitz with exponent 1: the longest tails, isotropic.

    $$D = \frac{\alpha^2 - 1}{\pi\,\log\alpha^2\,
          (\alpha^2\cos^2\theta_h + \sin^2\theta_h)}$$

    uniform, $1/\pi$, at $\alpha = 1$.

    Source:
        B. Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course notes,
        appendix B.2.
    """
    x, y, z = wh
    scale = 1 / numerics.norm_of(x, y, z)
    u, v = x * scale, y * scale
    square = alpha * alpha
    peak = (alpha + 1) / (2 * jnp.pi * numerics.log_ratio(alpha))
    return peak / (square + (1 - alpha) * (1 + alpha) * (u * u + v * v))


def blinn(wh: Direction, exponent: Scalar) -> Scalar:
    r"""Blinn: a power of the cosine.

    $$D = \frac{p + 2}{2\pi}\,\cos^p\theta_h$$

    Close to Beckmann with $\alpha^2 = 2 / (p + 2)$ when $p$ is large.

    Source:
        J. F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures",
        SIGGRAPH 1977; normalised in B. Walter et al., EGSR 2007.
    """
    lobe = jnp.exp(-0.5 * exponent * jnp.log1p(tan_squared(wh)))
    return (exponent + 2) / (2 * jnp.pi) * lobe


def student_t(wh: Direction, alpha_x: Scalar, alpha_y: Scalar, gamma: Scalar) -> Scalar:
    r"""Student's t distribution of slopes: GGX at ``gamma = 2``, Beckmann in the limit.

    $$D = \frac{1}{\pi\,\alpha_x\alpha_y\cos^4\theta_h}\,\Bigl(1 +
          \frac{(h_x/\alpha_x)^2 + (h_y/\alpha_y)^2}{(\gamma - 1)\,h_z^2}
          \Bigr)^{-\gamma}$$

    Source:
        M. Ribardiere et al., "STD: Student's t-Distribution of Slopes for Microfacet
        Based BSDFs", Computer Graphics Forum 36(2), 2017.
    """
    x, y, z = wh
    u, v = x / z, y / z
    a, b = u / alpha_x, v / alpha_y
    tail = jnp.log1p((a * a + b * b) / (gamma - 1))
    exponent = 2 * jnp.log1p(u * u + v * v) - gamma * tail
    return jnp.exp(exponent) / (jnp.pi * alpha_x * alpha_y)
