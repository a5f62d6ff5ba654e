"""Images as linear float32 arrays ``(row, column, channel)``, top row first.

EXR is the format of record and keeps every value. Radiance HDR has a shared exponent
and about 8 bits a channel below the largest; PNG and TIFF are 16-bit and hold values
from 0 to 1, taken as linear whatever colour space the file names. Only `write_preview`
encodes for a screen.
"""

import contextlib
import os
import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import OpenEXR
from jaxtyping import Bool, UInt8

from brdffit.files import refuse_bomb, replacing
from brdffit.types import Image

RGB = ("R", "G", "B")
INTEGER = (".png", ".tif", ".tiff")
SUFFIXES = (".exr", ".hdr", *INTEGER)
EIGHT_BITS = "has 8 bits a channel, too few: save it as linear EXR, 16-bit PNG or TIFF."


class Picture(NamedTuple):
    """Pixels of an image file with the names of its channels."""

    pixels: Image
    channels: tuple[str, ...]


def read(path: str | Path) -> Picture:
    """Linear float32 pixels of an EXR, HDR, 16-bit PNG or TIFF.

    Integers are divided by the largest of their type. Pixels that are not finite are
    kept in place for the caller to mask, with a warning that counts them.

    Raises:
        OSError: The file is missing, empty, truncated or not an image.
        ValueError: The suffix is unknown, or the file has 8 bits a channel.
    """
    path = existing(path)
    if path.suffix.lower() == ".exr":
        picture = _read_exr(path)
    else:
        stored, channels = _read_stored(path)
        if stored.dtype == np.uint8:
            raise ValueError(f"Image `{path}` {EIGHT_BITS}")
        picture = Picture(as_float32(stored), channels)
    broken = np.count_nonzero(~np.isfinite(picture.pixels).all(axis=-1))
    if broken:
        warnings.warn(
            f"Image `{path}` has {broken} pixels that are not finite.", stacklevel=2
        )
    return picture


def read_mask(path: str | Path) -> Bool[np.ndarray, "row column"]:
    """True where any colour of an image, of any depth, is above zero.

    Raises:
        OSError: The file is missing, empty, truncated or not an image.
    """
    path = existing(path)
    exr = path.suffix.lower() == ".exr"
    pixels, channels = _read_exr(path) if exr else _read_stored(path)
    colours = [i for i, name in enumerate(channels) if name != "A"]
    return np.max(pixels[..., colours], axis=-1) > 0


def write(path: str | Path, image: Image, channels: tuple[str, ...] = ()) -> None:
    """Write linear pixels as the suffix says; float32 in EXR, 16 bits in PNG and TIFF.

    Args:
        path: A file name that ends in .exr, .hdr, .png, .tif or .tiff.
        image: Linear values, shape ``(row, column, channel)``.
        channels: A name for each channel, kept by EXR only; R, G, B (or Y for a single
            channel, numbers otherwise) when empty.

    Raises:
        OSError: The file cannot be written.
        ValueError: The suffix is unknown, or the format cannot hold these values.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    image = np.asarray(image, np.float32)
    count = image.shape[-1]
    channels = channels or {1: ("Y",), 3: RGB}.get(count, tuple(map(str, range(count))))
    if suffix not in SUFFIXES:
        raise ValueError(_unknown_suffix(path))
    if not len(set(channels)) == len(channels) == count:
        raise ValueError(
            f"Image `{path}` must have a name for each of its {count} channels, but "
            f"has {', '.join(channels)}."
        )
    if suffix == ".exr":
        return _write_exr(path, image, channels)
    if count not in (1, 3) or (suffix == ".hdr" and count != len(RGB)):
        raise ValueError(f"Image `{path}` has {count} channels: write it as EXR.")
    largest = 1 if suffix in INTEGER else np.finfo(np.float32).max
    if not np.all((image >= 0) & (image <= largest)):  # also finds NaN
        raise ValueError(
            f"Image `{path}` has values that {suffix[1:].upper()} cannot hold (below 0"
            f"{', above 1' if suffix in INTEGER else ''} or not finite): write it as "
            "EXR."
        )
    if suffix in INTEGER:
        image = np.round(np.asarray(image, np.float64) * 65535).astype(np.uint16)
    return _write_stored(path, image)


def preview(image: Image, exposure: float = 1.0) -> UInt8[np.ndarray, "row column 3"]:
    """Pixels for a screen: 8-bit sRGB of linear Rec. 709, clipped to its range.

    Three channels are taken as RGB; of any other number the mean is shown as grey.
    """
    with np.printoptions():  # which colour-science sets back to those of numpy 1.13
        import colour  # takes more than a second

    image = np.asarray(image, np.float64) * exposure
    if image.shape[-1] != len(RGB):
        image = np.repeat(image.mean(axis=-1, keepdims=True), len(RGB), axis=-1)
    shown = np.clip(np.nan_to_num(image), 0, 1)
    encoded = np.asarray(colour.cctf_encoding(shown, function="sRGB"))
    return np.round(encoded * 255).astype(np.uint8)


def write_preview(path: str | Path, image: Image, exposure: float = 1.0) -> None:
    """Write the `preview` of linear pixels as an 8-bit PNG.

    Raises:
        OSError: The file cannot be written.
    """
    _write_stored(Path(path), preview(image, exposure))


def _read_exr(path: Path) -> Picture:
    try:
        with silence():
            header = OpenEXR.File(str(path), header_only=True).header()
        low, high = np.asarray(header["dataWindow"], np.int64)
        rows, columns = (int(n) for n in high - low + 1)
        count = len(header["channels"])
    except (RuntimeError, ValueError, TypeError, KeyError) as error:
        raise OSError(f"Image `{path}` is not a complete EXR file.") from error
    refuse_bomb(path, rows * columns * count)
    try:
        with silence():
            planes = OpenEXR.File(str(path), separate_channels=True).channels()
            pixels = {name: planes[name].pixels for name in planes}
    except (RuntimeError, ValueError, TypeError) as error:
        raise OSError(f"Image `{path}` is not a complete EXR file.") from error
    if len({plane.shape for plane in pixels.values()}) != 1:
        raise OSError(f"Image `{path}` has channels of different sizes.")
    names = tuple(sorted(pixels, key=_channel_order))
    stack = np.stack([pixels[name] for name in names], axis=-1)
    return Picture(stack.astype(np.float32), names)


def _channel_order(name: str) -> list[tuple[int, str]]:
    """Red, green, blue first; then by name, numbers in it by their value."""
    if name in RGB:
        return [(RGB.index(name) - len(RGB), name)]
    parts = re.split(r"(\d+)", name)
    return [(int(part) if part.isdigit() else 0, part) for part in parts]


def _write_exr(path: Path, image: np.ndarray, channels: tuple[str, ...]) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    planes = np.moveaxis(image, -1, 0)
    named = {n: np.ascontiguousarray(p) for n, p in zip(channels, planes, strict=True)}
    with replacing(path) as temporary:
        try:
            with silence():
                OpenEXR.File(header, named).write(str(temporary))
        except RuntimeError as error:
            raise OSError(f"OpenEXR says: {error}") from error


def _read_stored(path: Path) -> tuple[np.ndarray, tuple[str, ...]]:
    """Numbers as the file stores them, and channels; alpha is not multiplied in."""
    import OpenImageIO  # slow to import, and not needed for EXR

    keep_alpha = OpenImageIO.ImageSpec()
    keep_alpha["oiio:UnassociatedAlpha"] = 1
    with silence():
        source = OpenImageIO.ImageInput.open(str(path), keep_alpha)
        if source:
            spec = source.spec()
            refuse_bomb(path, spec.width * spec.height * spec.nchannels)
        pixels = source.read_image(str(source.spec().format)) if source else None
        OpenImageIO.geterror()  # forget it, or it is printed at exit
    if source is None or pixels is None:
        kind = path.suffix[1:].upper()
        raise OSError(f"Image `{path}` is not a complete {kind} file.")
    return pixels, tuple(source.spec().channelnames)


def _write_stored(path: Path, image: np.ndarray) -> None:
    import OpenImageIO  # as above

    rows, columns, channels = image.shape
    spec = OpenImageIO.ImageSpec(columns, rows, channels, str(image.dtype))
    with replacing(path) as temporary:
        target = OpenImageIO.ImageOutput.create(str(temporary))
        done = (
            target is not None
            and target.open(str(temporary), spec)
            and target.write_image(np.ascontiguousarray(image))
            and target.close()
        )
        if not done:
            reason = target.geterror() if target else OpenImageIO.geterror()
            raise OSError(f"OpenImageIO says: {reason}")


def as_float32(pixels: np.ndarray) -> Image:
    """Stored numbers as linear values; integers are divided by the largest."""
    if np.issubdtype(pixels.dtype, np.integer):
        largest = np.iinfo(pixels.dtype).max
        return (pixels / np.float64(largest)).astype(np.float32)
    return pixels.astype(np.float32)


def existing(path: str | Path) -> Path:
    """The path of an image that is there and not empty."""
    path = Path(path)
    if not os.path.isfile(path):  # also where the name itself cannot be
        raise FileNotFoundError(f"Image `{path}` does not exist.")
    if path.stat().st_size == 0:
        raise OSError(f"Image `{path}` is empty.")
    if path.suffix.lower() not in SUFFIXES:
        raise ValueError(_unknown_suffix(path))
    return path


def _unknown_suffix(path: Path) -> str:
    return f"Image `{path}` must end in {', '.join(SUFFIXES)}."


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Keep decoders from printing what the caller says in a sentence."""
    saved = [(stream, os.dup(stream)) for stream in (1, 2)]
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
        for stream, _ in saved:
            os.dup2(nowhere.fileno(), stream)
        try:
            yield
        finally:
            for stream, copy in saved:
                os.dup2(copy, stream)
                os.close(copy)
