"""Integrals over all facets, as a fine sum over their slopes."""

import jax
import jax.numpy as jnp
import numpy as np

AROUND = 512  # azimuths


def facets(narrowest: float):
    """Bisectors ``(-p, -q, 1)`` of all slopes, and the area ``dp dq`` of each.

    Polar coordinates; the tangent of the angle to the normal runs evenly in its
    logarithm, from a thousandth of the narrowest slope to 1e9.
    """
    start, stop = np.log(narrowest * 1e-3), np.log(1e9)
    node, weight = np.polynomial.legendre.leggauss(400)
    log_slope = start + (stop - start) * (node + 1) / 2
    around = 2 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
    slope, phi = (a.ravel() for a in np.meshgrid(np.exp(log_slope), around))
    area = np.tile(weight * (stop - start) / 2, AROUND) * 2 * np.pi / AROUND * slope**2
    wh = np.stack([-slope * np.cos(phi), -slope * np.sin(phi), np.ones_like(phi)], 1)
    return jnp.asarray(wh), jnp.asarray(area)


def integrate(ndf, weight, narrowest: float) -> jax.Array:
    """Integral over the hemisphere of ``ndf(wh) weight(wh)``; wants float64.

    ``weight`` takes a bisector with third component 1 and is that of the unit vector
    times the length of the bisector.
    """
    wh, area = facets(narrowest)

    def share(wh):
        # solid angle dp dq / length^3, and once the length that weight is too large by
        length2 = jnp.sum(wh * wh)
        return ndf(wh) * weight(wh) / (length2 * length2)

    return jnp.sum(jax.vmap(share)(wh) * area)
