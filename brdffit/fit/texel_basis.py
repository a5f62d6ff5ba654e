r"""Rows of many small fits at once: what their linear parameters multiply.

The same as `basis`, with the texel as the last axis of every array: operations run
along texels, and what the texels share is worked out once.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from brdffit.fit.blocks import HARMLESS
from brdffit.fit.residual import Residual
from brdffit.fit.transforms import Layout, to_natural
from brdffit.models import AbstractBRDF
from brdffit.parameters import replace, values
from brdffit.types import AnyArray


class TexelProblem(eqx.Module):
    """What all texels have in common.

    Attributes:
        channels: The model cut into channels: leaves with a leading channel axis.
        lower, upper: Bounds of all parameters, in solver coordinates.
        layout: Where each parameter stands.
        residual: What is compared.
        moving: Nonlinear parameters that are not fixed.
    """

    channels: AbstractBRDF
    lower: Float[Array, " n"]
    upper: Float[Array, " n"]
    layout: Layout = eqx.field(static=True)
    residual: Residual = eqx.field(static=True)
    moving: tuple[str, ...] = eqx.field(static=True)

    @property
    def linear_places(self) -> np.ndarray:
        """Places ``(q, channel)`` of the linear parameters that each channel sees."""
        return self.layout.channel_places(self.layout.linear).T

    @property
    def local_places(self) -> np.ndarray:
        """Places ``(q + m, channel)`` of the linear and the moving ones."""
        return self.layout.channel_places(self.layout.linear + self.moving).T

    @property
    def solved_places(self) -> np.ndarray:
        """Places of what a step moves: not of the linear ones that are eliminated."""
        names = () if self.residual.affine else self.layout.linear
        names += self.moving
        return np.array([p for n in names for p in self.layout.places[n]], int)


class TexelBlock(eqx.Module):
    """Texels side by side, as they were observed; see `Texels`.

    ``whole`` is True when every value is finite.
    """

    wi: Float[AnyArray, "observation 3 _"]
    wo: Float[AnyArray, "observation 3 _"]
    weight: Float[AnyArray, "observation _ _"]
    value: Float[AnyArray, "observation channel texel"]
    mask: Bool[AnyArray, "observation _ _"] | None
    sigma: Float[AnyArray, "observation _ _"] | None
    whole: bool = eqx.field(static=True)


class Observed(eqx.Module):
    """A block made ready: the channel first, masked values without weight.

    Attributes:
        wi, wo: Directions, harmless ones where there is none.
        weight: What a unit of ``f_r`` adds to the value.
        value, target: Observations before and after the transform of the residual.
        lean: Weight of a difference from ``value``; 0 where masked.
        scale: Weight of a difference from ``target`` that means the same near it.
        count: Number of values used.
    """

    wi: Float[Array, "observation 3 _"]
    wo: Float[Array, "observation 3 _"]
    weight: Float[Array, "weights observation _"]
    value: Float[Array, "channel observation texel"]
    target: Float[Array, "channel observation texel"]
    lean: Float[Array, "leans observation _"]
    scale: Float[Array, "scales observation _"]
    count: Float[Array, " texel"]


def observed(problem: TexelProblem, block: TexelBlock) -> Observed:
    """Mask what cannot be used, and apply the transform of the residual.

    Left out: masked and non-finite values, values that no light reaches, directions at
    or below the horizon, and values <= 0 where the residual takes a logarithm.
    """
    up = (block.wi[:, 2:] > 0) & (block.wo[:, 2:] > 0)
    harmless = jnp.array(HARMLESS, block.wi.dtype)[None, :, None]
    wi, wo = (jnp.where(up, w, harmless) for w in (block.wi, block.wo))
    use = up & (block.weight > 0)
    if block.mask is not None:
        use &= block.mask
    if block.sigma is not None:
        use &= jnp.isfinite(block.sigma) & (block.sigma > 0)
    if not block.whole:
        use &= jnp.isfinite(block.value)
    if problem.residual.positive:
        use &= block.value > 0
    use = jnp.moveaxis(use, 1, 0)
    value = jnp.where(use, jnp.moveaxis(block.value, 1, 0), 1)
    used = use.astype(value.dtype)
    at = used if problem.residual.affine else value  # its slope is the same everywhere
    slope = compared(problem, wo, at)[1]
    if block.sigma is None:
        lean, scale = used * slope, used
    else:
        lean = used / jnp.where(use, jnp.moveaxis(block.sigma, 1, 0), 1)
        scale = lean / jnp.where(slope > 0, slope, 1)
    number = jnp.sum(used, axis=(0, 1)) * (value.shape[0] // used.shape[0])
    return Observed(
        wi=wi,
        wo=wo,
        weight=jnp.moveaxis(block.weight, 1, 0),
        value=value,
        target=compared(problem, wo, value)[0],
        lean=lean,
        scale=scale,
        count=jnp.broadcast_to(number, value.shape[-1:]),
    )


def compared(problem: TexelProblem, wo: Array, value: Array) -> tuple[Array, Array]:
    """Values ``(channel, observation, texel)`` after the transform, and its slope.

    The cosine of the light is in the weights already, as in images.
    """
    cosines = jnp.ones((1, 1, 1), value.dtype), wo[None, :, 2]
    return jax.jvp(
        lambda value: problem.residual.transform(value, *cosines),
        (value,),
        (jnp.ones_like(value),),
    )


def rows(
    problem: TexelProblem, seen: Observed, x: Array, derivatives: bool
) -> tuple[list[Array], list[list[Array]]]:
    """Constant and basis functions ``(channel or 1, observation, texel)`` of ``f_r``.

    Args:
        problem: What all texels have in common.
        seen: Their observations.
        x: All parameters ``(n, texel)``, or ``(n,)`` for the same in all texels, in
            solver coordinates; those of linear parameters do not matter.
        derivatives: Whether to differentiate.

    Returns:
        The rows, and their derivatives along each moving parameter.
    """
    layout = problem.layout
    groups = layout.channels if layout.separate else 1
    channels = jax.tree.map(lambda leaf: leaf[:groups], problem.channels)
    zero, one = (jnp.full((), number, seen.value.dtype) for number in (0, 1))
    count = len(layout.linear)
    own = {n: layout.channel_places((n,))[:groups, 0] for n in layout.nonlinear}
    first = {n: layout.places[n][:1] for n in layout.nonlinear}

    def basis(*moved):
        at = {name: x[places] for name, places in own.items()}
        at |= dict(zip(problem.moving, moved, strict=True))
        natural = {
            name: to_natural(layout, value[..., None], first[name])[..., 0]
            for name, value in at.items()
        }

        def reflectance(*linear):
            named = dict(zip(layout.linear, linear, strict=True))
            return _reflectance(channels, natural, named, seen.wi, seen.wo)

        # what the rows have in common is worked out once, not again in each of them
        linearised = jax.linearize(reflectance, *[zero] * count)
        value, push = jax.lax.optimization_barrier(linearised)
        pushed = [
            push(*(one if i == j else zero for j in range(count))) for i in range(count)
        ]
        return [value, *pushed]

    moved = [x[own[name]] for name in problem.moving]
    if not (derivatives and moved):
        return basis(*moved), []
    slopes = []
    for along in range(len(moved)):
        tangent = [
            (jnp.ones_like if i == along else jnp.zeros_like)(value)
            for i, value in enumerate(moved)
        ]
        slopes.append(jax.jvp(basis, moved, tangent)[1])
    return basis(*moved), slopes


def _reflectance(channels, natural, linear, wi: Array, wo: Array) -> Array:
    """``f_r (channel, observation, texel or 1)``, batched only over what differs."""

    def alone(channel, natural, linear, wi, wo):
        found = natural | linear
        shapes = {name: value.shape for name, value in values(channel).items()}
        brdf = replace(channel, {n: v.reshape(shapes[n]) for n, v in found.items()})
        return brdf.evaluate(wi, wo)[0]

    differ = [w.shape[-1] > 1 for w in (wi, wo)]
    wi, wo = (w if d else w[..., 0] for w, d in zip((wi, wo), differ, strict=True))
    each = {name: 0 if value.ndim > 1 else None for name, value in natural.items()}
    of_texel = [1 if d else None for d in differ]
    function = alone
    if any(differ) or 0 in each.values():
        function = jax.vmap(function, (None, each, None, *of_texel))
    over_observations = jax.vmap(function, (None, None, None, 0, 0))
    f_r = jax.vmap(over_observations, (0, 0, None, None, None))(
        channels, natural, linear, wi, wo
    )
    return f_r if f_r.ndim == 3 else f_r[..., None]
