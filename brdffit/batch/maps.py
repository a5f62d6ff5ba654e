"""A fitted texture as images: a map of every parameter, of its error, and of the fit.

The maps of a parameter ``alpha`` are called ``alpha`` and ``alpha_error``; those of the
fit are ``rms`` (of the residuals of a texel), ``converged`` and ``at_bound`` (1 or 0)
and ``steps``.
"""

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np
from jaxtyping import Float, Int, Shaped

from brdffit.plots.maps import Map

OF_FIT = ("rms", "converged", "at_bound", "steps")


@dataclasses.dataclass(frozen=True)
class Layout:
    """Where the texels of a stack lie in an image.

    Attributes:
        shape: Rows and columns.
        pixel: Of each texel, counted row by row from the top left.
    """

    shape: tuple[int, int]
    pixel: Int[np.ndarray, " texel"]

    def image(self, values: Shaped[np.ndarray, "channel texel"]) -> Map:
        """Values as an image; NaN where there is no texel."""
        flat = np.full((self.shape[0] * self.shape[1], len(values)), np.nan, np.float32)
        flat[self.pixel] = values.T
        return flat.reshape(*self.shape, len(values))


def maps(results: Any, layout: Layout) -> Iterator[tuple[str, Map]]:
    """Name and image of every map, read one after another.

    Args:
        results: The zarr group that `brdffit.fit_texture` wrote.
        layout: Of the stack that it fitted.
    """
    names = sorted(results["parameters"])
    for name in names:
        yield name, layout.image(numbers(results, f"parameters/{name}"))
        yield f"{name}_error", layout.image(numbers(results, f"standard_errors/{name}"))
    for name in OF_FIT:
        yield name, layout.image(numbers(results, name)[None])


def numbers(
    results: Any, name: str, texels: slice = slice(None)
) -> Float[np.ndarray, "... texel"]:
    """An array of a zarr group, of all texels or some, as float32."""
    return np.asarray(results[name][..., texels], np.float32)
