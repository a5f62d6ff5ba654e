"""Scenes as TOML files.

    exposure = 1.0                      # optional
    tangents = "cylindrical"            # or linear, radial; optional

    [camera]
    kind = "orthographic"
    resolution = 128

    [shape]
    kind = "sphere"

    [[lights]]
    kind = "directional"
    direction = [-0.48, 0.6, 0.64]      # unit vector towards the light
    irradiance = [1.0, 1.0, 1.0]        # or one number; optional

A table ``provenance`` may stand beside these, in the sidecar of an image; it says
where the pixels came from and is no part of the scene.
"""

import dataclasses
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import equinox as eqx
import numpy as np
import tomli_w

from brdffit.files import replacing
from brdffit.names import look_up
from brdffit.scene.camera import Orthographic
from brdffit.scene.lights import Directional
from brdffit.scene.scene import Scene
from brdffit.scene.shapes import Sphere

CAMERAS = {"orthographic": Orthographic}
SHAPES = {"sphere": Sphere}
LIGHTS = {"directional": Directional}
KIND_OF: dict[type[eqx.Module], str] = {
    made: kind for kinds in (CAMERAS, SHAPES, LIGHTS) for kind, made in kinds.items()
}


def load_scene(path: str | Path) -> Scene:
    """The scene described by a TOML file, or by the sidecar of an image.

    Raises:
        OSError: The file cannot be read.
        ValueError: The file is not TOML, or a key is unknown, missing or has a value
            that it cannot have; the message names file and key.
    """
    table = load_toml(path)
    try:
        return _scene({key: table[key] for key in table if key != "provenance"})
    except ValueError as error:
        raise ValueError(f"Scene `{path}`: {error}") from error


def save_scene(
    scene: Scene, path: str | Path, provenance: Mapping[str, Any] | None = None
) -> None:
    """Write a scene as a TOML file, with a table on where an image of it came from.

    Raises:
        OSError: The file cannot be written.
    """
    table = {
        "exposure": scene.exposure,
        "tangents": scene.tangents,
        "camera": _table(scene.camera),
        "shape": _table(scene.shape),
        "lights": [_table(light) for light in scene.lights],
    }
    if provenance is not None:
        table["provenance"] = dict(provenance)
    with replacing(path) as temporary:
        temporary.write_text(tomli_w.dumps(table), encoding="utf-8")


def load_toml(path: str | Path) -> dict[str, Any]:
    """A TOML file as nested dictionaries.

    Raises:
        OSError: The file cannot be read.
        ValueError: The file is not TOML.
    """
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise OSError(f"Scene `{path}` cannot be read: {error.strerror}.") from error
    except ValueError as error:  # of TOML and of its encoding
        raise ValueError(f"Scene `{path}` is not TOML: {error}.") from error


def _scene(table: dict[str, Any]) -> Scene:
    _check_keys(table, Scene)
    lights = table["lights"]
    if not isinstance(lights, list):
        raise ValueError("`lights` must be a list of tables, written [[lights]].")
    return Scene(
        camera=_part("camera", table["camera"], CAMERAS),
        shape=_part("shape", table["shape"], SHAPES),
        lights=tuple(
            _part(f"lights[{index}]", light, LIGHTS)
            for index, light in enumerate(lights)
        ),
        **{key: table[key] for key in ("exposure", "tangents") if key in table},
    )


def _part(place: str, table: Any, kinds: Mapping[str, type[eqx.Module]]) -> Any:
    """The camera, shape or light that one table of the file describes."""
    if not isinstance(table, dict):
        raise ValueError(f"`{place}` must be a table, but is {table!r}.")
    if not isinstance(table.get("kind"), str):
        raise ValueError(f"`{place}` must say its `kind`: {' or '.join(kinds)}.")
    made = look_up(kinds, table["kind"], f"`kind` of `{place}`,")
    rest = {key: value for key, value in table.items() if key != "kind"}
    try:
        _check_keys(rest, made)
        return made(**rest)
    except ValueError as error:
        raise ValueError(f"in `{place}`, {error}") from error


def _check_keys(table: Mapping[str, Any], made: type[eqx.Module]) -> None:
    fields = {field.name: field for field in dataclasses.fields(made)}
    for key in table:
        look_up(fields, key, "key")
    for name, field in fields.items():
        if field.default is dataclasses.MISSING and name not in table:
            raise ValueError(f"key `{name}` is missing.")


def _table(part: eqx.Module) -> dict[str, Any]:
    values = {f.name: getattr(part, f.name) for f in dataclasses.fields(part)}
    plain = {
        k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in values.items()
    }
    return {"kind": KIND_OF[type(part)], **plain}
