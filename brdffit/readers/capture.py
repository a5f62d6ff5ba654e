"""A surface photographed from one place under one light after another.

A folder holds photographs of a surface that does not move, and says how it was lit::

    scene.toml           camera, surface and lights, see brdffit.scene.files
    001.exr 002.exr ...  linear photographs, EXR or HDR, 16-bit PNG or TIFF, in the
                         order of their names, or in that of `filenames.txt`
    mask.png             optional: above zero where texels are wanted, else all are
    normals.exr          optional: a unit normal for each pixel in the frame of the
                         world, else that of the surface. Of 16-bit PNG or TIFF, the
                         normal is twice the number minus one

Light number k of the scene, directional or point, shines in photograph number k alone.
The surface is what has no material of its own, most often a plane. The resolution of
the camera is that of the photographs.

Or it is a folder as DiLiGenT has them, which `brdffit.readers.sphere_photos` describes:
`light_directions.txt` in place of the scene, an orthographic camera, and normals from
`Normal_gt.mat` or those of a ball that fills the mask.
"""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
from jaxtyping import Bool

from brdffit import images
from brdffit.readers import sphere_photos
from brdffit.readers.bands import Photograph
from brdffit.scene import Directional, Orthographic, Plane, Point, Scene, load_scene
from brdffit.types import Image

SCENE = "scene.toml"
MASK = "mask.png"
NORMALS = "normals"  # and a suffix of images


@dataclasses.dataclass(frozen=True)
class Capture:
    """What a folder of photographs says, before any pixel but the mask is read.

    Attributes:
        folder: Where it is.
        photographs: Files, open to be read in bands, all of one size.
        scene: Camera, surface and lights, one light for each photograph.
        mask: True where texels are wanted.
        normals: Unit normals of the rows from one to before another, in the frame of
            the world, or None where they are those of the surface.
        radiance: Of the pixel value 1.
    """

    folder: Path
    photographs: tuple[Photograph, ...]
    scene: Scene
    mask: Bool[np.ndarray, "row column"]
    normals: Callable[[int, int], Image] | None = None
    radiance: float = 1.0

    @property
    def names(self) -> list[str]:
        """Of the files, in the order of the lights."""
        return [photograph.path.name for photograph in self.photographs]

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels of the photographs."""
        return self.photographs[0].channels


def matches(path: Path) -> bool:
    """Whether a folder is one of those that `open_capture` opens."""
    return any((path / name).is_file() for name in (SCENE, sphere_photos.DIRECTIONS))


def open_capture(folder: Path) -> Capture:
    """Open a folder of photographs and check that its files fit each other.

    Raises:
        ValueError: They do not; the sentence says which.
        OSError: A file is missing, incomplete or no linear image.
    """
    if not matches(folder):
        raise OSError(
            f"Folder `{folder}` says nothing about its lights: it must hold {SCENE} or "
            f"{sphere_photos.DIRECTIONS}."
        )
    photographs = tuple(map(Photograph, sphere_photos.list_photographs(folder)))
    first = photographs[0]
    for other in photographs[1:]:
        if other.shape != first.shape:
            raise ValueError(
                f"Photographs of one surface must have one size, but `{first.path}` "
                f"has {_size(first.shape)} pixels and `{other.path}` "
                f"{_size(other.shape)}."
            )
        if other.channels != first.channels:
            raise ValueError(
                f"Photographs of one surface must have the same channels, but "
                f"`{first.path}` has {', '.join(first.channels)} and `{other.path}` "
                f"{', '.join(other.channels)}."
            )
    if (folder / SCENE).is_file():
        return _with_scene(folder, photographs)
    return _of_sphere(folder, photographs)


def _with_scene(folder: Path, photographs: tuple[Photograph, ...]) -> Capture:
    """A folder that has a scene."""
    file, first = folder / SCENE, photographs[0]
    scene = load_scene(file)
    if scene.camera.shape != first.shape:
        raise ValueError(
            f"Photograph `{first.path}` has {_size(first.shape)} pixels, but the "
            f"camera in `{file}` {_size(scene.camera.shape)}."
        )
    if len(scene.lights) != len(photographs):
        raise ValueError(
            f"Each photograph must have its light, but folder `{folder}` holds "
            f"{len(photographs)} photographs and `{SCENE}` {len(scene.lights)} lights."
        )
    for number, light in enumerate(scene.lights):
        if not isinstance(light, Directional | Point):
            raise ValueError(
                f"`lights[{number}]` in `{file}` must be directional or point, because "
                "a texel is fitted to one direction of light in each photograph."
            )
    if all(shape.material is not None for shape in scene.shapes):
        raise ValueError(
            f"No shape in `{file}` is there to be fitted: that which is photographed "
            "must have no material."
        )
    try:
        scene.channels_for(len(first.channels))
    except ValueError as error:
        raise ValueError(
            f"Scene `{file}` does not fit its photographs: {error}"
        ) from error
    mask = np.ones(first.shape, bool)
    if (folder / MASK).is_file():
        mask = images.read_mask(folder / MASK)
        _require_size(folder / MASK, mask.shape, first)
    return Capture(folder, photographs, scene, mask, _normal_map(folder, first))


def _of_sphere(folder: Path, photographs: tuple[Photograph, ...]) -> Capture:
    """A folder as DiLiGenT has them; the normals lie on a plane before the camera."""
    mask = images.read_mask(folder / MASK)
    _require_size(folder / MASK, mask.shape, photographs[0])
    lights = sphere_photos.read_lights(folder, len(photographs))
    camera = Orthographic(mask.shape)
    scene = Scene(camera, (Plane(normal=camera.towards),), lights)
    normals = np.zeros((*mask.shape, 3), np.float32)
    normals[mask] = sphere_photos.read_normals(folder, mask)
    return Capture(
        folder,
        photographs,
        scene,
        mask,
        lambda first, last: normals[first:last],
        sphere_photos.RADIANCE,
    )


def _normal_map(folder: Path, like: Photograph) -> Callable[[int, int], Image] | None:
    """What reads the normal map of a folder, if it has one."""
    found = [folder / f"{NORMALS}{suffix}" for suffix in images.SUFFIXES]
    found = [file for file in found if file.is_file()]
    if not found:
        return None
    source = Photograph(found[0])
    _require_size(source.path, source.shape, like)
    if len(source.channels) != 3:
        raise ValueError(
            f"Normals in `{source.path}` must have three channels x, y and z, but have "
            f"{len(source.channels)}."
        )
    encoded = source.path.suffix.lower() in images.INTEGER

    def rows(first: int, last: int) -> Image:
        numbers = source.rows(first, last)
        return 2 * numbers - 1 if encoded else numbers

    return rows


def _require_size(path: Path, shape: tuple[int, ...], like: Photograph) -> None:
    if shape != like.shape:
        raise ValueError(
            f"`{path}` has {_size(shape)} pixels, but the photographs have "
            f"{_size(like.shape)}."
        )


def _size(shape: tuple[int, ...]) -> str:
    return f"{shape[0]} x {shape[1]}"
