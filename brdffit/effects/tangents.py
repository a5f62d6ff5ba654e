"""Tangent fields: which way the grooves of an anisotropic surface run."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from brdffit import numerics
from brdffit.effects.decision import Decision, View, not_called_for, operations
from brdffit.geometry import (
    TANGENTS,
    any_tangent,
    cross,
    direction,
    shading_frame,
    to_frame,
)
from brdffit.models.base import AbstractBRDF

NAME = "tangents"
PAIRS = 64  # of directions at which anisotropy is measured


def decide(view: View) -> Decision:
    """A scene calls for it when a BRDF in it is anisotropic, or not known yet."""
    field = TANGENTS[view.scene.tangents]
    cost = operations(lambda n: field(n), np.zeros(3))
    own = [shape.material for shape in view.scene.shapes]
    known = [m for m in own if isinstance(m, AbstractBRDF)]
    handed = any(material is None for material in own)
    if handed and view.brdf is None:
        return Decision(
            NAME,
            needed=True,
            why="the BRDF is not known yet and may be anisotropic",
            error=1.0,
            cost=cost,
            on=True,
        )
    known += [view.brdf] if handed and view.brdf is not None else []
    grooved = [brdf for brdf in known if not is_isotropic(brdf)]
    if not grooved:
        return not_called_for(NAME, "every BRDF is isotropic")
    error = max(float(_turned(brdf)) for brdf in grooved)
    why = "a BRDF is anisotropic (error: its change when the surface turns by 90 deg)"
    return view.judged(NAME, error, cost, why)


def is_isotropic(brdf: AbstractBRDF) -> bool:
    """Whether a BRDF, and each part of a sum, is the same in all frames."""
    parts = [
        part
        for part in (getattr(brdf, "first", None), getattr(brdf, "second", None))
        if isinstance(part, AbstractBRDF)
    ]
    return all(is_isotropic(part) for part in parts) if parts else brdf.isotropic


@eqx.filter_jit
def _turned(brdf: AbstractBRDF) -> jax.Array:
    """Relative change of ``f_r cos_i`` when the surface turns by a right angle."""
    golden = (np.sqrt(5) - 1) / 2
    n = np.arange(PAIRS)
    theta, phi = np.arccos(1 - (n + 0.5) / PAIRS), 2 * np.pi * golden * n
    w = jax.vmap(direction)(jnp.asarray(theta), jnp.asarray(phi))
    wi, wo = w, jnp.roll(w, PAIRS // 3, axis=0)

    def at(wi, wo):
        return brdf(wi, wo) * wi[2]

    def turn(w):
        return jnp.stack([-w[:, 1], w[:, 0], w[:, 2]], axis=1)

    here, there = jax.vmap(at)(wi, wo), jax.vmap(at)(turn(wi), turn(wo))
    total = jnp.sum(here * here)
    return numerics.sqrt(numerics.divide(jnp.sum((here - there) ** 2), total))


def to_local(
    normal, to_viewer, towards, field: str | None
) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    """Components of local directions to the viewer ``(N,)`` and lights ``(N, L)``.

    Args:
        normal: The three components ``(N,)`` of unit normals in the world.
        to_viewer: Unit directions ``(N, 3)``.
        towards: Unit directions ``(N, L, 3)``, or ``(1, L, 3)`` where all are alike.
        field: Name of the field of tangents; None to take any direction that is
            perpendicular to the normal.
    """

    def at(normal, to_viewer, towards):
        tangent = any_tangent(normal)
        frame = tangent, cross(normal, tangent), normal
        if field is not None:
            along = TANGENTS[field](jnp.stack(normal))
            lost = jnp.all(along == 0)  # on the axis of the field
            grooved = shading_frame(normal, along)
            plain = jnp.stack([jnp.stack(axis) for axis in frame])
            frame = jnp.where(lost, plain, grooved)
        return to_frame(frame, to_viewer), jax.vmap(to_frame, (None, 0))(frame, towards)

    same = towards.shape[0] == 1
    return jax.vmap(at, in_axes=(0, 0, None if same else 0))(
        normal, to_viewer, towards[0] if same else towards
    )
