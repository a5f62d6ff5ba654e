"""A photograph held out of a fit, and what the fitted texture shows under its light."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from brdffit.batch.maps import Layout, numbers
from brdffit.batch.stack import Stack, arrays_of
from brdffit.fit.texels import Texels
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameters
from brdffit.plots.maps import Map
from brdffit.render import shade_texels

TEXELS = 2**16  # at once


@dataclasses.dataclass(frozen=True)
class Observations:
    """Some of the observations of a stack, as a stack of its own.

    Attributes:
        stack: The whole.
        chosen: Which observations.
    """

    stack: Stack
    chosen: tuple[int, ...]

    @property
    def texels(self) -> int:
        """Number of texels."""
        return self.stack.texels

    @property
    def channels(self) -> int:
        """Number of channels."""
        return self.stack.channels

    @property
    def shape(self) -> tuple[int, int] | None:
        """Rows and columns of the image that the texels make."""
        return self.stack.shape

    def read(self, start: int, stop: int) -> Texels:
        """Some texels."""
        chosen = list(self.chosen)
        whole = arrays_of(self.stack.read(start, stop))
        return Texels(**{name: array[chosen] for name, array in whole.items()})


def held_out(stack: Stack, count: int, place: int) -> tuple[Observations, Observations]:
    """All but one of so many observations, and that one."""
    others = tuple(number for number in range(count) if number != place)
    return Observations(stack, others), Observations(stack, (place,))


def relit(
    brdf: AbstractBRDF, results: Any, stack: Stack, layout: Layout
) -> tuple[Map, Map]:
    """A photograph, and what fitted texels show under its light.

    Args:
        brdf: The model that was fitted.
        results: The zarr group that `brdffit.fit_texture` wrote.
        stack: One observation of the same texels.
        layout: Of the stack.

    Returns:
        The photograph, NaN where it must not be used, and the prediction; both NaN
        where there is no texel or none was fitted.
    """
    photograph = np.full((brdf.channels, stack.texels), np.nan, np.float32)
    predicted = np.full_like(photograph, np.nan)
    for start in range(0, stack.texels, TEXELS):
        some = slice(start, min(start + TEXELS, stack.texels))
        texels = stack.read(some.start, some.stop)
        new = {
            name: numbers(results, f"parameters/{name}", some)
            for name in parameters(brdf)
        }
        shown = shade_texels(brdf, new, texels.wi, texels.wo, texels.weight)
        predicted[:, some] = np.asarray(shown)[0]
        used = np.isfinite(predicted[:, some])
        if texels.mask is not None:
            used &= texels.mask[0]
        photograph[:, some] = np.where(used, texels.value[0], np.nan)
    return layout.image(photograph), layout.image(predicted)


def relative_errors(photograph: Map, predicted: Map) -> Sequence[float]:
    """Root mean square of the difference over that of the photograph, per channel.

    All channels together come first.
    """
    used = np.isfinite(photograph)
    square = np.where(used, photograph, 0).astype(float) ** 2
    error = np.where(used, predicted - photograph, 0).astype(float) ** 2
    each = np.sqrt(error.sum(axis=(0, 1)) / square.sum(axis=(0, 1)))
    return [float(np.sqrt(error.sum() / square.sum())), *map(float, each)]
