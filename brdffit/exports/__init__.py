"""Materials for renderers: a BRDF in the words of each, with the error that it makes.

To add a renderer, write ``exports/<name>.py`` with

- ``DESCRIPTION``, one line, and the ``SUFFIX`` of its files;
- ``translate(brdf, channels)``, which returns a `Material`: what the target computes,
  what it is told, and a sentence for each thing that it does otherwise;

and add its line below. What a target cannot express is refused there, or the nearest
material that it can is taken; the error is worked out here for all alike.
"""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from brdffit.exports import glsl, gltf, materialx, merl, mitsuba
from brdffit.exports.deviation import Deviation, deviation
from brdffit.exports.material import evaluator, in_rgb
from brdffit.files import require_writable
from brdffit.models import AbstractBRDF
from brdffit.names import look_up

EXPORTS: dict[str, ModuleType] = {
    "mitsuba": mitsuba,
    "materialx": materialx,
    "gltf": gltf,
    "glsl": glsl,
    "merl": merl,
}
PACKAGES = {"mitsuba": "mitsuba", "MaterialX": "materialx", "pygltflib": "pygltflib"}


@dataclasses.dataclass(frozen=True)
class Exported:
    """What was exported, and how far it is from where it came from.

    Attributes:
        target: Name of the target.
        path: The file.
        parameters: What the target is told.
        deviation: Relative error of f_r.
        evaluator: Who evaluated the exported material.
        notes: A sentence for each thing that the target does otherwise.
    """

    target: str
    path: Path
    parameters: Mapping[str, Any]
    deviation: Deviation
    evaluator: str
    notes: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """The same in types that JSON knows."""
        fields = dataclasses.asdict(self)
        return fields | {"path": str(self.path), "notes": list(self.notes)}


def export(
    brdf: AbstractBRDF,
    target: str,
    path: Path | str,
    channels: Sequence[str] = (),
) -> Exported:
    """Write a BRDF as a material of a renderer, and evaluate what was written.

    Args:
        brdf: What to export; grey or RGB.
        target: Name of the renderer or format, one of `EXPORTS`.
        path: File to write, with the suffix of the target.
        channels: Names of the channels, if they are known.

    Raises:
        ValueError: No such target, another suffix, or a BRDF that it cannot express.
        OSError: The file cannot be written.
    """
    path = Path(path)
    module = look_up(EXPORTS, target, "Target")
    if path.suffix.lower() != module.SUFFIX:
        raise ValueError(
            f"File `{path}` must end in {module.SUFFIX}, as those of {target} do."
        )
    require_writable(path.parent)
    try:
        material = module.translate(brdf, channels)
        truth = evaluator(in_rgb(brdf, target, channels))
        error = deviation(truth, material.evaluate)
        material.write(path)
    except ModuleNotFoundError as missing:
        package = PACKAGES.get(missing.name or "", missing.name)
        raise ValueError(
            f"Export to {target} needs the package {package}, which is not installed: "
            f"pip install 'brdffit[export]'."
        ) from missing
    return Exported(
        target, path, material.parameters, error, material.evaluator, material.notes
    )
