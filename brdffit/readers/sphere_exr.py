"""EXR image of a lit sphere, with the scene that shows it in a TOML file beside it.

``ball.exr`` is read together with ``ball.toml``, which gives camera, lights and
exposure (see `brdffit.scene.files`). What an image of brdffit lacks to be a measurement
is only its geometry, which is traced again.
"""

import dataclasses
import warnings
from pathlib import Path

import numpy as np

from brdffit import images
from brdffit.files import refuse_bomb
from brdffit.readers import validity
from brdffit.render import trace
from brdffit.samples import Samples
from brdffit.scene import load_scene

DESCRIPTION = "EXR image of a lit sphere, with its scene in a TOML file beside it"
SUFFIXES = (".exr",)
BEGINS = "with the four bytes of OpenEXR"

MAGIC = b"\x76\x2f\x31\x01"


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a file begins as an EXR does."""
    return head.startswith(MAGIC)


def load(path: Path | str) -> Samples:
    """Read the pixels on the sphere; those that are not finite or not lit are masked.

    Raises:
        ValueError: The image does not fit its scene, or has no pixel that can be used.
        OSError: Image or scene is missing or incomplete.
    """
    path = Path(path)
    sidecar = path.with_suffix(".toml")
    if not sidecar.is_file():
        raise OSError(
            f"Image `{path}` has no scene beside it: write camera and lights into "
            f"`{sidecar.name}`, as brdffit.scene.files describes."
        )
    scene = load_scene(sidecar)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Image .* pixels that are not finite")
        pixels, channels = images.read(path)
    refuse_bomb(path, pixels.size, validity.SMALL)
    if pixels.shape[:2] != scene.camera.shape:
        raise ValueError(
            f"Image `{path}` has {pixels.shape[0]} x {pixels.shape[1]} pixels, but the "
            f"camera in `{sidecar.name}` has {scene.camera.shape[0]} x "
            f"{scene.camera.shape[1]}."
        )
    try:
        samples = trace(scene, channels=len(channels))
    except ValueError as error:
        raise ValueError(f"Image `{path}` does not fit its scene: {error}") from error
    assert samples.pixels is not None  # for the type checker
    value = pixels[samples.pixels.row, samples.pixels.column]
    lit = (samples.weight > 0).any(axis=1)
    if samples.ambient is not None:
        lit |= samples.ambient > 0
    mask = np.isfinite(value) & lit
    mask &= validity.above_horizon(samples.wo)[:, None]
    validity.refuse_unusable(path, mask)
    return dataclasses.replace(
        samples, value=value, mask=mask, channels=channels, name=path.stem
    )
