"""Folder of EXR images of one sphere, each with its scene in a TOML file beside it.

All images have one size, one list of channels and one number of lights; the lights
differ. The frame of a sample is the index of its image in the order of their names.
"""

import dataclasses
import os
from pathlib import Path

from brdffit.readers import sphere_exr
from brdffit.samples import Samples, join

DESCRIPTION = "folder of EXR images of a lit sphere, each with its scene beside it"
SUFFIXES = ()
BEGINS = "with pairs of EXR and TOML files in it"


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a folder holds an EXR image with a scene."""
    return path.is_dir() and bool(frames_of(path))


def load(path: Path | str) -> Samples:
    """Read all images; those without a scene beside them are left out.

    Raises:
        ValueError: An image does not fit its scene, or the images do not fit together.
        OSError: There is no image, or one is incomplete.
    """
    folder = Path(path)
    files = frames_of(folder)
    if not files:
        raise OSError(f"Folder `{folder}` holds no EXR image with a scene beside it.")
    frames = [sphere_exr.load(file) for file in files]
    kinds = {
        (frame.pixels and frame.pixels.shape, frame.wi.shape[1], frame.channels)
        for frame in frames
    }
    if len(kinds) > 1:
        raise ValueError(
            f"Images in folder `{folder}` must agree in size, number of lights and "
            f"channels, but differ; put them into folders of their own."
        )
    return dataclasses.replace(join(frames), name=folder.resolve().name)


def frames_of(folder: Path) -> list[Path]:
    """EXR files with a scene beside them, by name."""
    images = (file for file in folder.iterdir() if file.suffix.lower() == ".exr")
    return sorted(f for f in images if os.path.lexists(f.with_suffix(".toml")))
