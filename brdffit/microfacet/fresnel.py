"""Fresnel reflectance ``F(cos_d)`` of a smooth interface for unpolarised light.

``cos_d`` is the cosine between either direction and the half vector.
"""

from brdffit import numerics
from brdffit.types import Direction, Scalar, Spectrum


def cos_d(wh: Direction) -> Scalar:
    """``wi . wh`` from the bisector ``wi + wo``: half its length."""
    return numerics.norm_of(*wh) / 2


def schlick(cos_d: Scalar, f0: Scalar | Spectrum) -> Scalar | Spectrum:
    r"""Schlick's approximation.

    $$F = F_0 + (1 - F_0)(1 - \cos\theta_d)^5$$

    Source:
        C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering",
        Computer Graphics Forum 13(3), 1994, eq. 15.
    """
    remainder = 1 - cos_d
    square = remainder * remainder
    return f0 + (1 - f0) * (square * square * remainder)
