"""Normal distribution functions ``D``, in 1/sr, of a bisector of any length.

Only the slopes of ``wh`` and its direction matter, so the unnormalised ``wi + wo``
serves: it is exact near the mirror direction.
"""

import jax.numpy as jnp

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
    r"""GGX (Trowbridge-Reitz).

    $$D = \frac{1}{\pi\,\alpha_x\alpha_y\,\bigl((h_x/\alpha_x)^2 + (h_y/\alpha_y)^2
          + h_z^2\bigr)^2}$$

    Source:
        B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces",
        EGSR 2007, eq. 33.
    """
    x, y, z = wh
    u, v = x / alpha_x, y / alpha_y
    q = (x * x + y * y + z * z) / (u * u + v * v + z * z)
    return q * q / (jnp.pi * alpha_x * alpha_y)
