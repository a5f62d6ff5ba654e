"""Shapes: where a ray meets a surface, and the normal there."""

import equinox as eqx
import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import dot
from brdffit.types import Direction, Scalar


class Sphere(eqx.Module):
    """The unit sphere at the origin."""

    def intersect(
        self, origin: Direction, direction: Direction
    ) -> tuple[Scalar, Direction]:
        """Distance along a ray that starts outside, and the outward normal there.

        The distance is infinite where the ray misses. The discriminant comes from the
        point of the ray nearest to the centre, which loses no digits far away.

        Source:
            E. Haines, J. Gunther, T. Akenine-Moeller, "Precision Improvements for
            Ray/Sphere Intersection", Ray Tracing Gems, 2019, chapter 7, eq. 5.
        """
        along = -dot(origin, direction)
        nearest = origin + along * direction
        half_chord = numerics.sqrt(1 - dot(nearest, nearest))
        distance = along - half_chord
        hit = (half_chord > 0) & (distance >= 0)
        normal = nearest - half_chord * direction
        return jnp.where(hit, distance, jnp.inf), normal
