"""Photographs read a few rows at a time: memory holds a band of them, never all."""

from pathlib import Path

import numpy as np

from brdffit import images
from brdffit.files import refuse_bomb
from brdffit.types import Image


class Photograph:
    """A linear image file, open to be read in bands of rows from the top down.

    A tiled EXR has no rows to read, so it is held whole.

    Attributes:
        path: The file.
        shape: Rows and columns.
        channels: Names of the channels, alpha left out.
        full: Value from which on a pixel is saturated; infinite where a format has no
            largest number.

    Raises:
        OSError: The file is missing, empty or no image.
        ValueError: The suffix is unknown, the file has 8 bits a channel, or it claims
            far more pixels than it can hold.
    """

    def __init__(self, path: Path) -> None:
        """Open the file and read its header."""
        import OpenImageIO  # slow to import

        suffix = images.existing(path).suffix.lower()
        with images.silence():
            source = OpenImageIO.ImageInput.open(str(path))
            OpenImageIO.geterror()  # forget it, or it is printed at exit
        if source is None:
            raise OSError(
                f"Image `{path}` is not a complete {suffix[1:].upper()} file."
            )
        spec = source.spec()
        if str(spec.format) == "uint8":
            raise ValueError(f"Image `{path}` {images.EIGHT_BITS}")
        refuse_bomb(path, spec.width * spec.height * spec.nchannels)
        self.path, self._source = path, source
        self.shape: tuple[int, int] = spec.height, spec.width
        self.full = 1.0 if suffix in images.INTEGER else np.inf
        self._whole = images.read(path) if spec.tile_width else None
        names = self._whole.channels if self._whole else tuple(spec.channelnames)
        self._colours = [i for i, name in enumerate(names) if name != "A"]
        self.channels = tuple(names[i] for i in self._colours)

    def rows(self, first: int, last: int) -> Image:
        """Pixels ``(row, column, channel)`` from one row to before another.

        Raises:
            OSError: The file ends before them.
        """
        if self._whole is not None:
            return self._whole.pixels[first:last, :, self._colours]
        spec = self._source.spec()
        with images.silence():
            pixels = self._source.read_scanlines(
                spec.y + first, spec.y + last, 0, 0, spec.nchannels, str(spec.format)
            )
            self._source.geterror()  # as above
        if pixels is None:
            raise OSError(f"Image `{self.path}` ends before its last row.")
        return images.as_float32(pixels[..., self._colours])
