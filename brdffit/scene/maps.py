"""Maps: images laid onto something, looked up between their pixels."""

import warnings
from pathlib import Path
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit import images

Numbers = Float[np.ndarray, "row column channel"]
Places = Float[np.ndarray, "n 2"]


class Map(eqx.Module):
    """An image whose left and right ends meet, and whose top and bottom do not.

    Attributes:
        pixels: Values, shape ``(row, column, channel)``.
        file: Where they came from, or nothing.
    """

    pixels: Numbers
    file: str = eqx.field(static=True, default="")

    @staticmethod
    def of(key: str, source: Any) -> "Map":
        """The map of an image file, or of an array of two or three dimensions.

        Raises:
            ValueError: It is neither, the array is empty, or the image is no linear
                one; the sentence begins with the key.
            OSError: The file is missing or incomplete.
        """
        if isinstance(source, Map):
            return source
        if isinstance(source, str | Path):
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", message="Image .* not finite")
                try:
                    pixels, channels = images.read(source)
                except (ValueError, OSError) as error:
                    raise type(error)(f"`{key}`: {error}") from error
            colours = [i for i, name in enumerate(channels) if name != "A"]
            chosen = np.asarray(pixels, np.float64)[..., colours or [0]]
            return Map(chosen, str(source))
        try:
            array: np.ndarray = np.asarray(source, np.float64)
        except (TypeError, ValueError):
            array = np.asarray(0.0)
        if array.ndim == 2:
            array = array[..., None]
        if array.ndim != 3 or array.size == 0:
            raise ValueError(
                f"`{key}` must be an image file or an array of pixels, but is "
                f"{_told(source)}."
            )
        return Map(array)

    def __str__(self) -> str:
        """How sentences name it."""
        return f"`{self.file}`" if self.file else "the array of pixels"

    def __call__(
        self, place: Places, end: float | None = 1.0
    ) -> Float[np.ndarray, "n channel"]:
        """Values between pixel centres, interpolated in both directions.

        Args:
            place: Fractions of the width from the left and of the height from the top.
                The map repeats beyond both.
            end: Where the last map ends at the bottom and its last row goes on, as the
                first row does above the top; None to repeat without end.
        """
        rows, columns = self.pixels.shape[:2]
        x, y = place[:, 0] * columns - 0.5, place[:, 1] * rows - 0.5
        if end is not None:
            y = np.clip(y, 0, end * rows - 1)
        left, top = np.floor(x).astype(int), np.floor(y).astype(int)
        s, t = (x - left)[:, None], (y - top)[:, None]
        below = (top + 1 if end is None else np.ceil(y).astype(int)) % rows
        right = (left + 1) % columns
        left, top = left % columns, top % rows
        pixels = self.pixels
        upper = (1 - s) * pixels[top, left] + s * pixels[top, right]
        lower = (1 - s) * pixels[below, left] + s * pixels[below, right]
        return (1 - t) * upper + t * lower


def _told(source: Any) -> str:
    """A value as a sentence can hold it."""
    shown = repr(source)
    return shown if len(shown) < 60 else f"{shown[:57]}..."
