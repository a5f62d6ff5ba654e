"""Masking-shadowing functions, divided by the Jacobian of the half vector.

``G(wi, wo) / (4 cos_i cos_o)`` is finite at grazing angles; ``G`` alone would leave a
0 / 0 to every model.
"""

import jax.numpy as jnp

from brdffit import numerics
from brdffit.types import Direction, Scalar


def smith_ggx(
    wi: Direction, wo: Direction, alpha_x: Scalar, alpha_y: Scalar, separable: bool
) -> Scalar:
    r"""Smith masking-shadowing for GGX, over $4\cos_i\cos_o$.

    $$\frac{G}{4\cos_i\cos_o} = \frac{1}{2\,(\cos_o R_i + \cos_i R_o)}, \qquad
      R(\omega) = \sqrt{(\alpha_x x)^2 + (\alpha_y y)^2 + z^2}$$

    and $1 / \bigl((\cos_i + R_i)(\cos_o + R_o)\bigr)$ when separable.

    Source:
        E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
        BRDFs", JCGT 3(2), 2014, eq. 99 with the GGX Lambda of eq. 72.
    """
    (xi, yi, zi), (xo, yo, zo) = wi, wo
    ri = numerics.norm_of(alpha_x * xi, alpha_y * yi, zi)
    ro = numerics.norm_of(alpha_x * xo, alpha_y * yo, zo)
    if separable:
        return 1 / ((zi + ri) * (zo + ro))
    return 0.5 / (zo * ri + zi * ro)


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
    cos_i, cos_o = wi[2], wo[2]
    wh = wi + wo
    length = numerics.norm_of(*wh)
    # two divisions by the length: one by its square overflows in the gradient
    blocked = wh[2] / length / (length * jnp.maximum(cos_i, cos_o))
    return jnp.minimum(0.25 / (cos_i * cos_o), blocked)
