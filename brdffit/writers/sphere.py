"""Write a simulated image with its scene and truth beside it.

``ball.exr`` holds the linear values, ``ball.toml`` the scene (camera, shape, lights,
exposure) and the provenance, ``ball.png`` an 8-bit sRGB preview for looking at.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from brdffit import images
from brdffit.samples import Samples
from brdffit.scene import Scene, save_scene
from brdffit.types import Image


def save(
    samples: Samples,
    scene: Scene,
    path: Path | str,
    provenance: Mapping[str, Any] | None = None,
) -> None:
    """Write the values of ``samples`` as an EXR with sidecar and preview.

    Args:
        samples: Traced from ``scene``, with values; the background is 0.
        scene: What they were traced from.
        path: Of the EXR; the two other files take its name with another suffix.
        provenance: Model, parameters and noise, as far as they are known.

    Raises:
        ValueError: The samples have no values or no pixels, or the path does not end
            in .exr.
        OSError: A file cannot be written.
    """
    _require_exr(Path(path))
    if samples.value is None or samples.pixels is None:
        raise ValueError(f"Samples for `{path}` must have values and pixels.")
    image = samples.pixels.images(samples.value, background=0.0)[0]
    save_image(image, scene, path, samples.channels, provenance)


def save_image(
    image: Image,
    scene: Scene,
    path: Path | str,
    channels: tuple[str, ...] = (),
    provenance: Mapping[str, Any] | None = None,
) -> None:
    """Write a rendered image as `save` does, with a name for each channel.

    Raises:
        ValueError: The path does not end in .exr.
        OSError: A file cannot be written.
    """
    path = Path(path)
    _require_exr(path)
    save_scene(scene, path.with_suffix(".toml"), provenance)
    images.write(path, image, channels)
    images.write_preview(path.with_suffix(".png"), image)


def _require_exr(path: Path) -> None:
    if path.suffix.lower() != ".exr":
        raise ValueError(f"Image `{path}` must end in .exr to keep its values.")
