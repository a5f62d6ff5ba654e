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
from brdffit.fit.residual import Residual
from brdffit.samples import Samples
from brdffit.types import AnyArray

SIZE = 2048  # samples in a block: its rows fit into the second-level cache
AHEAD = 2  # blocks whose samples stand for all
HARMLESS = (0.6, 0.0, 0.8)  # direction of places that hold no sample


class Blocks(eqx.Module):
    """Samples in blocks ``(block, component, ..., place)``, or one block of them.

    Attributes:
        wi, wo: Directions.
        weight: What a unit of ``f_r`` adds to the value; one channel when all agree.
            One more than there are lights where there is ambient light: what a unit of
            diffuse reflectance adds.
        value: Observations.
        target: The observations after the transform of the residual.
        scale: Weight of a difference from ``target`` (a root: it enters squared); 0
            where masked.
        lean: Weight of a difference from ``value`` that means the same near it.
        share: What of ``scale`` is the share of the solid angle; None without any.
        cos_i, cos_o: Cosines a residual may use.
        count: Number of blocks that hold samples.
        known_sigma: True when the weights are standard deviations of the observations.
    """

    wi: Float[AnyArray, "*block 3 light place"]
    wo: Float[AnyArray, "*block 3 place"]
    weight: Float[AnyArray, "*block light_or_ambient channel_or_1 place"]
    value: Float[AnyArray, "*block channel place"]
    target: Float[AnyArray, "*block channel place"]
    scale: Float[AnyArray, "*block scales place"]
    lean: Float[AnyArray, "*block leans place"]
    cos_i: Float[AnyArray, "*block place"]
    cos_o: Float[AnyArray, "*block place"]
    count: Int[AnyArray, ""]
    share: Float[AnyArray, "*block 1 place"] | None
    known_sigma: bool = eqx.field(static=True)

    def used_share(self) -> Array:
        """``share``, 1 without any, and 0 where masked."""
        return jnp.where(self.scale > 0, 1 if self.share is None else self.share, 0)


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
    rows = _representative_first(samples, np.flatnonzero(use.any(axis=1)))
    samples, use = samples.take(rows), use[rows]
    base, share = use.astype(float), None
    if samples.solid_angle is not None:
        share = np.sqrt(samples.solid_angle / samples.solid_angle.mean())[:, None]
        base = base * share

    up = (samples.wi[..., 2] > 0) & (samples.wo[:, 2] > 0)[:, None]
    wi = np.where(up[..., None], samples.wi, HARMLESS)
    weight = np.where(up[..., None], samples.weight, 0)
    if samples.ambient is not None:
        ambient = np.asarray(samples.ambient)[:, None]
        weight = np.concatenate([weight, ambient], axis=1)

    count, lights = len(samples), wi.shape[1]
    number = -(-count // SIZE)
    room = _bucket(number)

    def lay(array, fill, dtype: Any = dtype):
        """``(N, ...)`` to ``(block, ..., place)``."""
        padded = np.full((room * SIZE, *array.shape[1:]), fill, dtype)
        padded[:count] = array
        return np.moveaxis(padded.reshape(room, SIZE, *array.shape[1:]), 1, -1)

    def lay_directions(w):
        """The same with the components next to the blocks."""
        return np.moveaxis(lay(w, HARMLESS), -2, 1)

    value = lay(np.where(use, np.asarray(samples.value), 1), 1, np.float64)
    cosines = lay(samples.cosine, HARMLESS[2]), lay(samples.wo[:, 2], HARMLESS[2])
    target, slope = map(np.asarray, _compared(value, *cosines, residual=residual))
    scale = lay(base, 0, np.float64)
    if samples.sigma is None:
        lean = scale * slope
    else:
        lean = scale / lay(np.where(use, samples.sigma, 1), 1, np.float64)
        scale = np.where(slope > 0, lean / np.where(slope > 0, slope, 1), 0)
    return Blocks(
        wi=lay_directions(wi),
        wo=lay_directions(samples.wo),
        weight=lay(_once(weight, axis=-1), 1 / lights),
        value=value.astype(dtype),
        target=target.astype(dtype),
        scale=_once(scale, axis=1).astype(dtype),
        lean=_once(lean, axis=1).astype(dtype),
        cos_i=cosines[0],
        cos_o=cosines[1],
        count=np.asarray(number, np.int32),
        share=None if share is None else lay(share, 1),
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


def _representative_first(samples: Samples, rows: np.ndarray) -> np.ndarray:
    """The rows in an order in which the first stand for all.

    Of each block's worth three quarters are every so-manieth, one of the brightest.
    """
    ahead = AHEAD * SIZE
    if len(rows) <= ahead:
        return rows
    bright = np.argsort(np.nansum(np.asarray(samples.value)[rows], axis=1))
    bright = bright[-max(len(rows) // 20, 1) :]
    bright = bright[:: max(1, len(bright) // (ahead // 4))][: ahead // 4]
    rest = np.setdiff1d(np.arange(len(rows)), bright, assume_unique=True)
    even = rest[np.linspace(0, len(rest) - 1, ahead - len(bright)).astype(int)]
    first = np.concatenate([bright, even])
    others = np.setdiff1d(np.arange(len(rows)), first, assume_unique=True)
    return rows[np.concatenate([first, others])]


def _once(array: np.ndarray, axis: int) -> np.ndarray:
    """One channel instead of all, which stand along an axis, when they agree."""
    first = array.take([0], axis)
    return first if np.all(array == first) else array


def _bucket(number: int) -> int:
    """Blocks to make room for: one of few numbers, so that few programs are compiled.

    Empty blocks cost memory but no time; beyond 64 they add a quarter at most.
    """
    room = 1
    while room < number:
        room = 4 * room if room < 64 else room + max(room // 4, 1)
    return room
