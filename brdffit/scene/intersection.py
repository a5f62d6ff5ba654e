"""Where a ray meets a shape: one ray, one sphere, plane or triangle.

Pure JAX functions, batched from outside. Each returns the distance along the ray, which
must be above ``least``, and infinity for a miss.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from brdffit import numerics
from brdffit.geometry import dot
from brdffit.types import Direction, Scalar

EDGE_ON = 1e-12  # sine of the angle to the plane below which a triangle has no width
SEAM = 1e-14  # overlap of neighbours, relative to the distance in their edges


def sphere(
    origin: Direction,
    direction: Direction,
    centre: Direction,
    radius: Scalar,
    least: Scalar,
) -> tuple[Scalar, tuple[Scalar, ...]]:
    """Distance, and the outward normal at the point met, from outside or inside.

    The normal is returned by components, so that no program has to interleave them.

    The discriminant comes from the point of the ray nearest to the centre, which loses
    no digits far away.

    Source:
        E. Haines, J. Gunther, T. Akenine-Moeller, "Precision Improvements for
        Ray/Sphere Intersection", Ray Tracing Gems, 2019, chapter 7, eq. 5.
    """
    start = [o - c for o, c in zip(origin, centre, strict=True)]
    along = -dot(start, direction)
    nearest = [s + along * d for s, d in zip(start, direction, strict=True)]
    half_chord = numerics.sqrt(radius * radius - dot(nearest, nearest))
    entering = along - half_chord > least
    step = jnp.where(entering, -half_chord, half_chord)
    distance = along + step
    hit = (half_chord > 0) & (distance > least)
    met = zip(nearest, direction, strict=True)
    normal = tuple((n + step * d) / radius for n, d in met)
    return jnp.where(hit, distance, jnp.inf), normal


def plane(
    origin: Direction,
    direction: Direction,
    point: Direction,
    normal: Direction,
    least: Scalar,
) -> Scalar:
    """Distance to a plane, from either side."""
    slope = dot(direction, normal)
    height = dot(origin - point, normal)
    distance = jnp.where(slope == 0, jnp.inf, numerics.divide(-height, slope))
    return jnp.where(distance > least, distance, jnp.inf)


def triangle(
    origin: Direction,
    direction: Direction,
    corners: Float[Array, "3 3"],
    least: Scalar,
) -> tuple[Scalar, Scalar, Scalar]:
    r"""Distance, and the weights of the second and third corner at the point met.

    $$\begin{pmatrix} t \\ u \\ v \end{pmatrix} = \frac{1}{p \cdot e_1}
      \begin{pmatrix} q \cdot e_2 \\ p \cdot s \\ q \cdot d \end{pmatrix},
      \qquad p = d \times e_2,\; q = s \times e_1,\; s = o - a$$

    Both sides are met. A ray in the plane of the triangle misses it: it sees an edge
    of no width. What counts as that is relative to the lengths of the edges, so that
    small and large triangles are treated alike. A ray through an edge that two
    triangles share meets at least one of them: each reaches beyond its edges by more
    than the rounding of the distance.

    Source:
        T. Moeller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection",
        Journal of Graphics Tools 2(1), 1997.
    """
    e1, e2 = corners[1] - corners[0], corners[2] - corners[0]
    s = origin - corners[0]
    long, wide = dot(e1, e1), dot(e2, e2)
    distance, u, v = on_plane_of(origin, direction, corners)
    far = numerics.sqrt(numerics.divide(dot(s, s), jnp.minimum(long, wide)))
    seam = SEAM * (1 + far)
    inside = (u >= -seam) & (v >= -seam) & (u + v <= 1 + seam)
    return jnp.where(inside & (distance > least), distance, jnp.inf), u, v


def on_plane_of(
    origin: Direction, direction: Direction, corners: Float[Array, "3 3"]
) -> tuple[Scalar, Scalar, Scalar]:
    """As `triangle`, for the whole plane of the triangle: also beyond its edges."""
    e1, e2 = corners[1] - corners[0], corners[2] - corners[0]
    s = origin - corners[0]
    p, q = jnp.cross(direction, e2), jnp.cross(s, e1)
    volume = dot(p, e1)
    flat = jnp.abs(volume) <= EDGE_ON * numerics.sqrt(dot(e1, e1) * dot(e2, e2))
    inverse = numerics.divide(jnp.ones_like(volume), jnp.where(flat, 0.0, volume))
    distance = jnp.where(flat, jnp.inf, dot(q, e2) * inverse)
    return distance, dot(p, s) * inverse, dot(q, direction) * inverse


def normal_of(corners: Float[Array, "3 3"]) -> Direction:
    """Unit normal of a triangle, towards those who see its corners anticlockwise."""
    return numerics.normalize(
        jnp.cross(corners[1] - corners[0], corners[2] - corners[0])
    )
