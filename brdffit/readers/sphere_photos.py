r"""Folder of linear photographs of a sphere, each under one distant light.

The layout of the photometric-stereo set DiLiGenT (Shi et al. 2019)::

    mask.png                 above zero where the sphere is seen
    light_directions.txt     one line `x y z` for each photograph: x right, y up, z to
                             the camera
    light_intensities.txt    one line `R G B` for each photograph; may be missing, then
                             all lights are equal
    Normal_gt.mat            normals as a MATLAB array `Normal_gt`; may be missing, then
                             they are those of the sphere that fills the mask
    001.png 002.png ...      the photographs, in the order of their names, or in that of
                             `filenames.txt`: 16-bit PNG or TIFF, EXR or HDR, linear

The camera is orthographic and looks along -z.

Scale: nothing in such a folder says what a pixel is in absolute units. By the custom of
photometric stereo, a white diffuse surface that faces a light of intensity 1 has the
pixel value 1, where 1 is the largest integer of the file or the number 1.0 in EXR. So
the value of a sample is the pixel divided by pi, and its weight is intensity times
cosine; f_r is right up to one factor common to all pixels.

Masked: saturated pixels (1 or more in PNG and TIFF), pixels that are not finite, and
those in attached shadow, whose weight is 0.
"""

import dataclasses
import itertools
import os
import struct
import warnings
import zlib
from pathlib import Path

import numpy as np

from brdffit import images
from brdffit.files import refuse_bomb
from brdffit.images import RGB
from brdffit.readers import text, validity
from brdffit.render import local_samples
from brdffit.samples import Pixels, Samples, join
from brdffit.scene import Directional, Orthographic, Scene, Sphere

DESCRIPTION = "folder of photographs of a sphere with light_directions.txt"
SUFFIXES = ()
BEGINS = "with a file light_directions.txt in it"

DIRECTIONS = "light_directions.txt"
INTENSITIES = "light_intensities.txt"
NORMALS = "Normal_gt"
RADIANCE = float(1 / np.pi)  # of the pixel value 1, as said above
MATLAB_HEADER, PACKED = 128, 15  # bytes; what a packed array begins with
SLACK = 1_000_000  # bytes of a MATLAB file beside the normals
NO_PHOTOGRAPHS = ("mask", "normal")  # how names of other images in the folder begin


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a folder holds light directions."""
    return (path / DIRECTIONS).is_file()


def load(path: Path | str) -> Samples:
    """Read all photographs; the frame of a sample is the index of its photograph.

    Raises:
        ValueError: Files of the folder do not fit each other, or no pixel can be used.
        OSError: A file is missing, incomplete or no linear image.
    """
    folder = Path(path)
    photographs = list_photographs(folder)
    lights = read_lights(folder, len(photographs))
    seen = images.read_mask(folder / "mask.png")
    numbers = int(seen.sum()) * len(RGB) * len(photographs)
    refuse_bomb(folder, numbers, validity.SMALL)
    normal = read_normals(folder, seen)
    frames = [
        read_frame(photograph, light, seen, normal)
        for photograph, light in zip(photographs, lights, strict=True)
    ]
    samples = join(frames)
    validity.refuse_unusable(folder, np.asarray(samples.mask))
    return dataclasses.replace(samples, name=folder.resolve().name)


def list_photographs(folder: Path) -> list[Path]:
    """The photographs, in the order of ``filenames.txt`` or of their names."""
    listing = folder / "filenames.txt"
    if os.path.lexists(listing):
        left = {file.name for file in folder.iterdir()}
        found = []
        for row in text.lines(listing):
            if row.text not in left:
                raise row.error(
                    "it must be the name of a file in the same folder, named once."
                )
            left.remove(row.text)
            found.append(folder / row.text)
    else:
        found = sorted(
            file
            for file in folder.iterdir()
            if file.suffix.lower() in images.SUFFIXES
            and not file.stem.lower().startswith(NO_PHOTOGRAPHS)
        )
    if not found:
        raise OSError(
            f"Folder `{folder}` holds no photographs: they must end in "
            f"{', '.join(images.SUFFIXES)}."
        )
    return found


def read_lights(folder: Path, count: int) -> list[Directional]:
    """The light of each photograph."""
    directions = read_list(folder / DIRECTIONS, count)
    listing = folder / INTENSITIES
    intensities = read_list(listing, count) if os.path.lexists(listing) else None
    lights = []
    for index, row in enumerate(directions):
        brightness = intensities[index].numbers() if intensities else 1.0
        try:
            lights.append(Directional(row.numbers(), brightness))
        except ValueError as error:
            raise ValueError(
                f"Light {index + 1} of folder `{folder}`: {error}"
            ) from error
    return lights


def read_list(file: Path, count: int) -> list[text.Line]:
    """The lines of a file that has one for each photograph."""
    rows = list(itertools.islice(text.lines(file), count + 1))
    if len(rows) != count:
        found = f"{len(rows)}" if len(rows) < count else "more"
        raise ValueError(
            f"Folder `{file.parent}` holds {count} photographs, but {file.name} has "
            f"{found} lines."
        )
    return rows


def read_normals(folder: Path, seen: np.ndarray) -> np.ndarray:
    """Unit normals ``(N, 3)`` of the pixels in the mask."""
    if not seen.any():
        raise ValueError(f"The mask of folder `{folder}` is empty.")
    file = folder / f"{NORMALS}.mat"
    if not os.path.lexists(file):
        return normals_of_disc(folder, seen)
    import scipy.io  # slow to import, and seldom needed

    try:
        refuse_packed(file, seen.size)
        shapes = {name: shape for name, shape, _ in scipy.io.whosmat(file)}
        fits = shapes.get(NORMALS) == (*seen.shape, 3)
        array = (
            scipy.io.loadmat(file, variable_names=NORMALS)[NORMALS] if fits else None
        )
    except Exception as error:  # scipy raises nearly every kind on a damaged file
        raise OSError(f"`{file}` is no complete MATLAB file.") from error
    if array is None or array.dtype.kind not in "fiu":
        raise ValueError(
            f"`{file}` must hold an array `{NORMALS}` as large as the mask, with three "
            f"numbers for each pixel."
        )
    normal = array[seen].astype(np.float64)
    if not np.allclose(np.linalg.norm(normal, axis=1), 1, atol=1e-2):
        raise ValueError(f"Normals in `{file}` must be unit vectors within the mask.")
    return normal


def refuse_packed(file: Path, pixels: int) -> None:
    """Refuse a MATLAB file that unpacks to more than normals in double precision.

    An array that is packed begins with the number 15 and its size in the file.
    """
    most = SLACK + pixels * 3 * 8
    with file.open("rb") as stream:
        stream.seek(MATLAB_HEADER)
        while len(head := stream.read(8)) == 8:
            kind, size = struct.unpack("<II", head)
            content = stream.read(size)
            if (
                kind == PACKED
                and len(zlib.decompressobj().decompress(content, most)) == most
            ):
                raise ValueError


def normals_of_disc(folder: Path, seen: np.ndarray) -> np.ndarray:
    """Normals of the sphere whose outline is the mask; z is 0 beyond its edge."""
    row, column = np.nonzero(seen)
    radius = np.sqrt(len(row) / np.pi)
    x, y = (column - column.mean()) / radius, (row.mean() - row) / radius
    outside = np.hypot(x, y).max()
    if outside > 1 + 3 / radius:  # pixels
        raise ValueError(
            f"The mask of folder `{folder}` is not a disc (it reaches {outside:.2f} "
            f"radii from its centre), so normals must be given in {NORMALS}.mat."
        )
    return np.stack([x, y, np.sqrt(np.maximum(1 - x * x - y * y, 0))], axis=1)


def read_frame(
    photograph: Path, light: Directional, seen: np.ndarray, normal: np.ndarray
) -> Samples:
    """One photograph as samples; its pixels are those of the mask."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Image .* pixels that are not finite")
        picture, channels = images.read(photograph)
    if picture.shape[:2] != seen.shape:
        raise ValueError(
            f"Photograph `{photograph}` is {picture.shape[0]} x {picture.shape[1]} "
            f"pixels, but the mask {seen.shape[0]} x {seen.shape[1]}."
        )
    row, column = np.nonzero(seen)
    scene = Scene(Orthographic(1), (Sphere(),), (light,))
    viewer = np.broadcast_to([0.0, 0.0, 1.0], normal.shape)
    where = Pixels(np.zeros_like(row), row, column, (1, *seen.shape))
    try:
        samples = local_samples(normal, viewer, scene, len(channels), where)
    except ValueError as error:
        raise ValueError(f"Photograph `{photograph}`: {error}") from error
    pixel = picture[row, column]
    mask = np.isfinite(pixel) & (samples.weight > 0).any(axis=1)
    mask &= validity.above_horizon(samples.wo)[:, None]
    if photograph.suffix.lower() in images.INTEGER:
        mask &= pixel < 1
    value = pixel * np.float32(RADIANCE)
    return dataclasses.replace(samples, value=value, mask=mask, channels=channels)
