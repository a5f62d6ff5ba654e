r"""Normal distribution functions ``D``, in 1/sr, of a bisector of any length.

Only the slopes of ``wh`` and its direction matter, so the unnormalised ``wi + wo``
serves: it is exact near the mirror direction. All are normalised to
$\int D \cos\theta_h\,d\omega_h = 1$ over the hemisphere.
"""

import jax.numpy as jnp

from brdffit import numerics
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


def gtr1(wh: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""Generalised Trowbridge-Reitz with exponent 1: the longest tails.

    $$D = \frac{\alpha^2 - 1}{\pi\,\log\alpha^2\,
          (\alpha^2\cos^2\theta_h + \sin^2\theta_h)}$$

    uniform, $1/\pi$, at $\alpha = 1$. With two roughnesses it is that of
    $\alpha = \sqrt{\alpha_x\alpha_y}$, its slopes stretched by $\alpha_x/\alpha$ and
    $\alpha_y/\alpha$: $D(M\omega_h)\,|M\omega_h|^{-4}$ with
    $M = \mathrm{diag}(\alpha/\alpha_x, \alpha/\alpha_y, 1)$.

    Source:
        B. Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course notes,
        appendix B.2, where it is isotropic; stretched as in E. Heitz, "Understanding
        the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014.
    """
    x, y, z = wh
    alpha = numerics.sqrt(alpha_x * alpha_y)
    p, q = x * (alpha / alpha_x), y * (alpha / alpha_y)
    scale = 1 / numerics.norm_of(p, q, z)
    stretch = numerics.norm_of(x, y, z) * scale
    u, v, stretch = p * scale, q * scale, stretch * stretch
    peak = (alpha + 1) / (2 * jnp.pi * numerics.log_ratio(alpha))
    spread = alpha * alpha + (1 - alpha) * (1 + alpha) * (u * u + v * v)
    return peak * (stretch * stretch) / spread


def blinn(wh: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar:
    r"""Blinn: a power of the cosine, of which the azimuth decides.

    $$D = \frac{1}{\pi\,\alpha_x\alpha_y}\,\cos^p\theta_h, \qquad
      p = 2\,\frac{(h_x/\alpha_x)^2 + (h_y/\alpha_y)^2}{h_x^2 + h_y^2} - 2$$

    For equal alphas the exponent is $2/\alpha^2 - 2$, with which the peak is that of
    Beckmann, $(p + 2)/2\pi$.

    Source:
        J. F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures",
        SIGGRAPH 1977; normalised, with this exponent, in B. Walter et al., EGSR 2007;
        stretched as in M. Ashikhmin and P. Shirley, "An Anisotropic Phong BRDF Model",
        Journal of Graphics Tools 5(2), 2000.
    """
    x, y, z = wh
    u, v = x / z, y / z
    power = u * u * _excess(alpha_x) + v * v * _excess(alpha_y)
    lobe = jnp.exp(-power * numerics.log1p_ratio(u * u + v * v))
    return lobe / (jnp.pi * alpha_x * alpha_y)


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
