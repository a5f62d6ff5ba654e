r"""Albedo: the share of light that a BRDF reflects, by rules that see its lobe.

A rule uniform in solid angle loses a narrow lobe. Here nodes lie where lobes are, in
two systems of coordinates, and end exactly at the horizon:

- slopes of the half vector, for lobes about it: nodes on lines parallel to the tangent
  and to the bitangent crowd towards slope 0 over ten decades, so that a lobe may be
  narrow along either axis alone, and stretched as it is at grazing angles;
- polar coordinates about a direction, for lobes that are round about it.

Measured against rules with twice the nodes over the models at incidence up to 89.99
degrees: the error is below 1e-4, and mostly below 1e-6; it is largest where masking has
kinks (`cook_torrance`, 9e-5 at 89 degrees). Lobes 1e-4 wide along one axis and broad
along the other reach 2e-4. The integral is in float64 whatever the precision of its
arguments, since a narrow lobe at grazing angles is narrower than the rounding of a
direction to float32.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, PyTree

from brdffit import numerics
from brdffit.geometry import direction, rotate_to
from brdffit.models.base import AbstractBRDF
from brdffit.models.sum import Sum
from brdffit.types import Direction, Scalar, Spectrum

Nodes = Float[Array, " node"]
Rule = tuple[Float[Array, "3 node"], Nodes]  # directions, weights with the cosine

NARROW = 96  # nodes between slope 0 and slope 1
WIDE = 32  # nodes from slope 1 to the horizon
CROWDING = 10.0  # nodes reach down to exp(-10) of an interval and further
TURN = 0.6  # azimuth of light on an isotropic surface: no kink along a line of nodes


def directional_albedo(brdf: AbstractBRDF, wi: Direction) -> Spectrum:
    """Integral over ``wo`` of ``f_r cos_o``: the share of light from ``wi`` reflected.

    Per channel, in [0, 1] for a model that conserves energy.
    """
    if isinstance(brdf, Sum):
        first = directional_albedo(brdf.first, wi)
        return first + directional_albedo(brdf.second, wi)
    return _in_double(brdf, wi)


@jax.custom_jvp
def _in_double(brdf: AbstractBRDF, wi: Direction) -> Spectrum:
    with jax.enable_x64(True):
        return _reflected(*_double(brdf, wi)).astype(wi.dtype)


@_in_double.defjvp
def _in_double_jvp(primals, tangents):
    # all derivatives at once: a transpose taken later would not know of float64
    brdf, wi = primals
    with jax.enable_x64(True):
        by = jax.jacrev(_reflected, argnums=(0, 1))(*_double(brdf, wi))
        by = jax.tree.map(lambda x: x.astype(wi.dtype), by)
    pairs = zip(jax.tree.leaves(by), jax.tree.leaves(tangents), strict=True)
    changes = [jnp.tensordot(slope, moved, moved.ndim) for slope, moved in pairs]
    return _in_double(brdf, wi), jnp.sum(jnp.stack(changes), axis=0)


def _double(*arguments: PyTree) -> PyTree:
    return jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), arguments)


def _reflected(brdf: AbstractBRDF, wi: Direction) -> Spectrum:
    """The integral in the precision of its arguments."""
    if brdf.isotropic:
        x, y, z = wi
        across = numerics.norm_of(x, y)
        wi = jnp.stack([across * np.cos(TURN), across * np.sin(TURN), z])
    axis = brdf.lobe_axis(wi)
    wo, weight = about_half_vector(wi) if axis is None else about(axis)
    return weight @ jax.vmap(brdf, (None, 1))(wi, wo)


def hemispherical_albedo(brdf: AbstractBRDF) -> Spectrum:
    """Share of light reflected when light comes evenly from the whole hemisphere."""
    if isinstance(brdf, Sum):
        return hemispherical_albedo(brdf.first) + hemispherical_albedo(brdf.second)
    t, weight = gauss_legendre(24)
    azimuths = 1 if brdf.isotropic else 16
    turns = 2 * np.pi * (np.arange(azimuths) + 0.5) / azimuths
    # cos_i = t^2: nodes crowd towards grazing, where the albedo of a lobe changes
    theta, phi = (a.ravel() for a in np.meshgrid(np.arccos(t * t), turns))
    share = np.tile(weight * 4 * t**3 / azimuths, azimuths)
    wi = jax.vmap(direction)(jnp.asarray(theta), jnp.asarray(phi))
    albedo = jax.lax.map(lambda wi: directional_albedo(brdf, wi), wi)
    return jnp.asarray(share, wi.dtype) @ albedo


def about_half_vector(wi: Direction) -> Rule:
    r"""Directions whose half vectors lie on lines of equal slope.

    The half vector $(-p, -q, 1)$ belongs to a direction above the horizon when
    $p^2 + q^2 + 2(p x + q y)/z < 1$, a disc about $-(x, y)/z$ of radius $1/z$.
    """
    x, y, z = wi
    # ends of the disc, written without the difference of 1 and nearly 1
    rest = x * x + z * z
    highest = jnp.where(y > 0, rest / (1 + jnp.abs(y)), 1 - y) / z
    lowest = -jnp.where(y < 0, rest / (1 + jnp.abs(y)), 1 + y) / z
    q, across = _through_zero(lowest, highest)

    def line(q: Scalar) -> tuple[Nodes, Nodes]:
        half = numerics.sqrt((highest - q) * (q - lowest))
        larger = -x / z - jnp.where(x > 0, half, -half)
        product = q * q + 2 * (y / z) * q - 1
        other = numerics.divide(product, larger)
        return _through_zero(jnp.minimum(larger, other), jnp.maximum(larger, other))

    p, along = jax.vmap(line)(q)
    weight = (along * across[:, None]).ravel()
    q, p = jnp.broadcast_to(q[:, None], p.shape).ravel(), p.ravel()
    length2 = 1 + p * p + q * q
    facing = z - x * p - y * q  # wi . wh times the length
    stretch = 2 * facing / length2
    wo = jnp.stack([-stretch * p - x, -stretch * q - y, stretch - z])
    # solid angle: 4 wi.wh that of the half vector, which is dp dq / length^3
    weight = weight * 4 * facing / (length2 * length2)
    return wo, weight * jnp.maximum(wo[2], 0.0)


def about(axis: Direction) -> Rule:
    """Directions on rays that leave ``axis``, up to the horizon."""
    x, y, z = axis
    t, step = gauss_legendre(WIDE)
    # quarters meet where rays begin to reach the horizon late
    turns = np.pi / 2 * np.concatenate([t, t + 1, t + 2, t + 3])
    chi = numerics.arctan2(y, x) + jnp.asarray(turns, z.dtype)
    unit, share = (jnp.asarray(a, z.dtype) for a in _crowded(NARROW))

    def ray(chi: Scalar) -> tuple[Float[Array, "3 node"], Nodes]:
        cos_chi, sin_chi = jnp.cos(chi), jnp.sin(chi)
        end = numerics.arctan2(z, x * cos_chi + y * sin_chi)
        psi = end * unit
        sin_psi = jnp.sin(psi)
        local = jnp.stack([sin_psi * cos_chi, sin_psi * sin_chi, jnp.cos(psi)])
        return local, end * share * sin_psi

    local, along = jax.vmap(ray, out_axes=(1, 0))(chi)
    wo = jax.vmap(rotate_to, (None, 1), 1)(axis, local.reshape(3, -1))
    around = jnp.asarray(np.pi / 2 * np.tile(step, 4), z.dtype)
    weight = (along * around[:, None]).ravel()
    return wo, weight * jnp.maximum(wo[2], 0.0)


def _through_zero(low: Scalar, high: Scalar) -> tuple[Nodes, Nodes]:
    """Nodes and weights from ``low`` to ``high`` that crowd towards 0 on both sides."""
    right, step_right = _outward(jnp.maximum(low, 0.0), jnp.maximum(high, 0.0))
    left, step_left = _outward(jnp.maximum(-high, 0.0), jnp.maximum(-low, 0.0))
    nodes = jnp.concatenate([right, -left])
    return nodes, jnp.concatenate([step_right, step_left])


def _outward(near: Scalar, far: Scalar) -> tuple[Nodes, Nodes]:
    """Nodes from ``near`` to ``far``: up to 1 crowded, beyond it in equal ratios."""
    unit, share = (jnp.asarray(a, near.dtype) for a in _crowded(NARROW))
    t, step = (jnp.asarray(a, near.dtype) for a in gauss_legendre(WIDE))
    top = jnp.clip(1.0, near, far)
    close = near + (top - near) * unit
    ratio = jnp.log(jnp.maximum(far, 1.0) / jnp.maximum(top, 1.0))
    distant = top * jnp.exp(ratio * t)
    weight = [(top - near) * share, ratio * distant * step]
    return jnp.concatenate([close, distant]), jnp.concatenate(weight)


def _crowded(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on (0, 1) of which half lie below 0.04, a tenth below 4e-5."""
    t, step = gauss_legendre(count)
    decades = np.exp(-CROWDING * (1 - t) ** 2)
    return t * decades, step * decades * (1 + 2 * CROWDING * t * (1 - t))


def gauss_legendre(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of the Gauss-Legendre rule on (0, 1)."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2
