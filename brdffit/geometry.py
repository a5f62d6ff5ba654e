"""Directions in the local shading frame.

Conventions, stated here and nowhere else:

- the normal is ``n = (0, 0, 1)``, the tangent ``(1, 0, 0)``;
- ``wi`` points to the light, ``wo`` to the viewer; both leave the surface;
- ``wh`` is the half vector between them;
- ``f_r`` is in 1/sr and never contains the cosine of the incident angle; it is 0 when
  either direction lies at or below the horizon;
- angles are in radians; directions are unit vectors.
"""

from collections.abc import Sequence

import jax.numpy as jnp
from jaxtyping import Array, Float

from brdffit import numerics
from brdffit.types import Direction, Scalar

Components = Direction | Sequence[Scalar]


def cos_theta(w: Direction) -> Scalar:
    """Cosine of the angle between ``w`` and the normal."""
    return w[2]


def dot(a: Components, b: Components) -> Scalar:
    """Cosine of the angle between two directions, by components."""
    (ax, ay, az), (bx, by, bz) = a, b
    return ax * bx + ay * by + az * bz


def cross(a: Components, b: Components) -> tuple[Scalar, Scalar, Scalar]:
    """Components of the vector product."""
    (ax, ay, az), (bx, by, bz) = a, b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def bisector(wi: Direction, wo: Direction) -> Direction:
    """``wi + wo``, the half vector before it is normalised.

    Its slopes ``x/z``, ``y/z`` are those of the half vector, and exact near the mirror
    direction, where the normalised vector has lost them to rounding.
    """
    return wi + wo


def larger_cosine(wi: Direction, wo: Direction) -> Scalar:
    """Cosine to the normal of the direction that is closer to it.

    Where cosines are equal to the last digit, sines still tell, so that the derivative
    is that by the right direction; by both in equal parts where sines are equal too.
    """
    (xi, yi, zi), (xo, yo, zo) = wi, wo
    behind = (zi == zo) & (xi * xi + yi * yi > xo * xo + yo * yo)
    ahead = (zi == zo) & (xi * xi + yi * yi < xo * xo + yo * yo)
    return jnp.where(ahead, zi, jnp.where(behind, zo, jnp.maximum(zi, zo)))


def tan_squared(w: Direction) -> Scalar:
    """Squared tangent of the angle to the normal; ``w`` may have any length."""
    x, y, z = w
    u, v = x / z, y / z
    return u * u + v * v


def half_vector(wi: Direction, wo: Direction) -> Direction:
    """Unit vector half-way between ``wi`` and ``wo``."""
    return numerics.normalize(wi + wo)


def direction(theta: Scalar, phi: Scalar) -> Direction:
    """Unit vector with polar angle ``theta`` and azimuth ``phi``, in radians."""
    sin_theta = jnp.sin(theta)
    return jnp.stack(
        [sin_theta * jnp.cos(phi), sin_theta * jnp.sin(phi), jnp.cos(theta)]
    )


def mirror(w: Direction) -> Direction:
    """Mirror image of ``w`` about the normal."""
    x, y, z = w
    return jnp.stack([-x, -y, z])


def mirror_cosine(wi: Direction, wo: Direction) -> Scalar:
    """Cosine of the angle between ``wo`` and the mirror image of ``wi``."""
    return dot(mirror(wi), wo)


def mirror_deficit(wi: Direction, wo: Direction) -> Scalar:
    """1 minus `mirror_cosine`.

    Half the squared distance of the two, which keeps its digits near the mirror
    direction, where a cosine has none left.
    """
    (xi, yi, zi), (xo, yo, zo) = wi, wo
    x, y, z = xi + xo, yi + yo, zi - zo
    return 0.5 * (x * x + y * y + z * z)


def rotate_to(axis: Direction, w: Direction) -> Direction:
    """Turn ``w`` by the shortest rotation that takes the normal to ``axis``.

    ``axis`` must not be the negative normal.
    """
    x, y, z = axis
    shear = 1 / (1 + z)
    u = jnp.stack([1 - x * x * shear, -x * y * shear, -x])
    v = jnp.stack([-x * y * shear, 1 - y * y * shear, -y])
    return w[0] * u + w[1] * v + w[2] * axis


def linear_tangent(normal: Direction) -> Direction:
    """Tangent that follows the x axis, as on a surface brushed in straight lines.

    Zero where the normal is the axis itself.
    """
    x, y, z = normal
    return numerics.normalize(jnp.stack([y * y + z * z, -x * y, -x * z]))


def radial_tangent(normal: Direction) -> Direction:
    """Tangent that runs away from the z axis, as spokes of a wheel seen from +z.

    Towards +x where the normal is the axis itself.
    """
    x, y, z = normal
    away = numerics.normalize(jnp.stack([x * z, y * z, -x * x - y * y]))
    on_axis = (x == 0) & (y == 0)
    return jnp.where(on_axis, jnp.array([1.0, 0.0, 0.0], away.dtype), away)


def cylindrical_tangent(normal: Direction) -> Direction:
    """Tangent that runs around the y axis, as circles of latitude do on a sphere.

    Towards +x where the normal is +z; zero where the normal is the axis itself.
    """
    x, _, z = normal
    return numerics.normalize(jnp.stack([z, jnp.zeros_like(z), -x]))


TANGENTS = {
    "linear": linear_tangent,
    "radial": radial_tangent,
    "cylindrical": cylindrical_tangent,
}
"""Tangent fields by the name that a scene calls them."""


def any_tangent(normal: Components) -> tuple[Scalar, Scalar, Scalar]:
    """Components of some unit vector perpendicular to a normal.

    Continuous but at z = 0.

    Source:
        T. Duff et al., "Building an Orthonormal Basis, Revisited", Journal of Computer
        Graphics Techniques 6(1), 2017.
    """
    x, y, z = normal
    sign = jnp.where(z < 0, -1.0, 1.0)
    a = -1 / (sign + z)
    return 1 + sign * x * x * a, sign * x * y * a, -sign * x


def shading_frame(normal: Components, tangent: Components) -> Float[Array, "3 3"]:
    """Rows tangent, bitangent, normal: ``frame @ w`` is ``w`` in the local frame.

    ``tangent`` need not be perpendicular to ``normal``, only not parallel to it.
    """
    bitangent = numerics.normalize(jnp.stack(cross(normal, tangent)))
    rows = cross(bitangent, normal), bitangent, normal
    return jnp.stack([jnp.stack(list(row)) for row in rows])


def to_frame(
    frame: Float[Array, "3 3"] | Sequence[Components], w: Components
) -> tuple[Scalar, ...]:
    """Components of ``frame @ w``."""
    return tuple(dot(axis, w) for axis in frame)
