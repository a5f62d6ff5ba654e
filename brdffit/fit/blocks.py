"""Samples laid out for the solver: components first, in blocks of equal size.

Reductions over blocks keep memory flat and are summed in double precision; the size of
a block is one of a few, so that another file seldom needs another compilation.
"""

from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from brdffit.compiled import compiled
from brdffit.fit.order import HARMLESS, in_order, lit_first
from brdffit.fit.residual import Residual
from brdffit.samples import Samples
from brdffit.types import AnyArray

SIZE = 2048  # samples in a block: its rows fit into the second-level cache
AHEAD = 1  # blocks whose samples stand for all


class Lights(eqx.Module):
    """Lights of all blocks, one block's after the other's, or one; none is dark.

    Attributes:
        wi: Directions.
        weight: What a unit of ``f_r`` adds to the value; one channel when all agree.
    """

    wi: Float[AnyArray, "*light 3 place"]
    weight: Float[AnyArray, "*light channel_or_1 place"]

    def at(self, i: AnyArray) -> "Lights":
        """One of them."""
        return jax.tree.map(partial(_one, i=i), self)


class Blocks(eqx.Module):
    """Samples in blocks ``(block, component, place)``, or one block of them.

    Attributes:
        lights: From where the samples of all blocks are lit.
        first: Place of the first light of the block among these.
        lit: Number of lights that reach any sample of the block; at least 1.
        ambient: What a unit of diffuse reflectance adds to the value, or None.
        wo: Directions to the viewer.
        value: Observations.
        target: The observations after the transform of the residual.
        scale: Weight of a difference from ``target`` (a root: it enters squared); 0
            where masked.
        lean: Weight of a difference from ``value`` that means the same near it.
        share: What of ``scale`` is the share of the solid angle; None without any.
        cos_i, cos_o: Cosines a residual may use.
        count: Number of blocks that hold samples.
        several: True when some samples are lit by more than one light.
        known_sigma: True when the weights are standard deviations of the observations.
    """

    lights: Lights
    first: Int[AnyArray, "*block"]
    lit: Int[AnyArray, "*block"]
    ambient: Float[AnyArray, "*block channel_or_1 place"] | None
    wo: Float[AnyArray, "*block 3 place"]
    value: Float[AnyArray, "*block channel place"]
    target: Float[AnyArray, "*block channel place"]
    scale: Float[AnyArray, "*block scales place"]
    lean: Float[AnyArray, "*block leans place"]
    cos_i: Float[AnyArray, "*block place"]
    cos_o: Float[AnyArray, "*block place"]
    count: Int[AnyArray, ""]
    share: Float[AnyArray, "*block 1 place"] | None
    several: bool = eqx.field(static=True)
    known_sigma: bool = eqx.field(static=True)

    def at(self, i: Array) -> "Blocks":
        """One block; the lights of all stay together."""

        def pick(leaf):
            if isinstance(leaf, Lights) or leaf.ndim == 0:  # the count
                return leaf
            return _one(leaf, i)

        return jax.tree.map(pick, self, is_leaf=lambda leaf: isinstance(leaf, Lights))

    def used_share(self) -> Array:
        """``share``, 1 without any, and 0 where masked."""
        return jnp.where(self.scale > 0, 1 if self.share is None else self.share, 0)


def _one(array: AnyArray, i: AnyArray) -> Array:
    return jax.lax.dynamic_index_in_dim(array, i, keepdims=False)


def usable(samples: Samples, residual: Residual) -> np.ndarray:
    """Which values ``(N, C)`` a fit may use under a residual.

    Left out: masked and non-finite values, values that no light reaches, directions at
    or below the horizon, and values <= 0 where the residual takes a logarithm.
    """
    value, weight = np.asarray(samples.value), np.asarray(samples.weight)
    lit = (samples.wi[..., 2] > 0)[..., None] & (weight > 0)
    lit = lit.any(axis=1)
    if samples.ambient is not None:
        lit |= np.asarray(samples.ambient) > 0
    use = np.isfinite(value) & lit & (samples.wo[:, 2] > 0)[:, None]
    if samples.mask is not None:
        use &= samples.mask
    if samples.sigma is not None:
        use &= np.isfinite(samples.sigma) & (np.asarray(samples.sigma) > 0)
    if residual.positive:
        use &= np.where(np.isfinite(value), value, 0) > 0
    return use


def blocks(
    samples: Samples, use: np.ndarray, residual: Residual, dtype: np.dtype
) -> Blocks:
    """Lay out the samples of which at least one value is used.

    Weights are the inverse of the known standard deviations, carried through the
    transform of the residual, times the root of the share of the solid angle.
    """
    rows = np.flatnonzero(use.any(axis=1))
    above = np.asarray(samples.wi)[..., 2] > 0
    lit = above & (np.asarray(samples.weight) > 0).any(axis=-1)
    lit = lit[rows] & (samples.wo[rows, 2] > 0)[:, None]
    order = in_order(np.asarray(samples.value)[rows], lit.sum(axis=1), AHEAD * SIZE)
    rows, lit = rows[order], lit[order]
    samples, use = samples.take(rows), use[rows]
    base, share = use.astype(float), None
    if samples.solid_angle is not None:
        share = np.sqrt(samples.solid_angle / samples.solid_angle.mean())[:, None]
        base = base * share

    wi, weight = lit_first(lit, np.asarray(samples.wi), np.asarray(samples.weight))

    count = len(samples)
    number = -(-count // SIZE)
    room = _bucket(number)

    def lay(array, fill, dtype: Any = dtype):
        """``(N, ...)`` to ``(block, ..., place)``."""
        padded = np.full((room * SIZE, *array.shape[1:]), fill, dtype)
        padded[:count] = array
        return np.moveaxis(padded.reshape(room, SIZE, *array.shape[1:]), 1, -1)

    value = lay(np.where(use, np.asarray(samples.value), 1), 1, np.float64)
    cosines = lay(samples.cosine, HARMLESS[2]), lay(samples.wo[:, 2], HARMLESS[2])
    target, slope = map(np.asarray, _compared(value, *cosines, residual=residual))
    scale = lay(base, 0, np.float64)
    reached = np.maximum(lay(lit.sum(axis=1), 0, np.int32).max(axis=-1), 1)
    of_block = np.repeat(np.arange(room), reached)
    first = np.cumsum(reached) - reached
    lights = of_block, np.arange(len(of_block)) - first[of_block]
    if samples.sigma is None:
        lean = scale * slope
    else:
        lean = scale / lay(np.where(use, samples.sigma, 1), 1, np.float64)
        scale = np.where(slope > 0, lean / np.where(slope > 0, slope, 1), 0)
    return Blocks(
        lights=Lights(
            wi=_with_room(lay(wi, HARMLESS)[lights], 1.0),
            weight=_with_room(lay(_once(weight, axis=-1), 1)[lights], 0.0),
        ),
        first=first.astype(np.int32),
        lit=reached,
        ambient=None
        if samples.ambient is None
        else lay(_once(np.asarray(samples.ambient), axis=-1), 1),
        wo=lay(samples.wo, HARMLESS),
        value=value.astype(dtype),
        target=target.astype(dtype),
        scale=_once(scale, axis=1).astype(dtype),
        lean=_once(lean, axis=1).astype(dtype),
        cos_i=cosines[0],
        cos_o=cosines[1],
        count=np.asarray(number, np.int32),
        share=None if share is None else lay(share, 1),
        several=wi.shape[1] > 1,
        known_sigma=samples.sigma is not None,
    )


@partial(compiled, static=("residual",))
def _compared(value, cos_i, cos_o, residual: Residual):
    """Transform of values ``(block, channel, place)`` in their precision, and slope."""
    cosines = cos_i[:, None].astype(value.dtype), cos_o[:, None].astype(value.dtype)
    return jax.jvp(
        lambda value: residual.transform(value, *cosines),
        (value,),
        (jnp.ones_like(value),),
    )


def _once(array: np.ndarray, axis: int) -> np.ndarray:
    """One channel instead of all, which stand along an axis, when they agree."""
    first = array.take([0], axis)
    return first if np.all(array == first) else array


def _with_room(array: np.ndarray, fill: float) -> np.ndarray:
    """The array with more entries along its first axis: one of few numbers."""
    more = _bucket(max(len(array), 1)) - len(array)
    widths = [(0, more)] + [(0, 0)] * (array.ndim - 1)
    return np.pad(array, widths, constant_values=fill) if more else array


def _bucket(number: int) -> int:
    """Blocks to make room for: one of few numbers, so that few programs are compiled.

    Empty blocks cost memory but no time; beyond 64 they add a quarter at most.
    """
    room = 1
    while room < number:
        room = 4 * room if room < 64 else room + max(room // 4, 1)
    return room
