"""Scenes as TOML files.

    exposure = 1.0                      # optional, as all that is marked so
    tangents = "cylindrical"            # optional: or linear, radial
    depth = 6                           # optional: reflections and refractions at most

    [camera]
    kind = "orthographic"               # or "perspective", with a position
    resolution = 128                    # or [rows, columns]

    [[shapes]]
    kind = "sphere"                     # or "plane" (point, normal), "mesh" (file)
    centre = [0.0, 0.0, 0.0]            # optional
    radius = 1.0                        # optional

    [shapes.height]                     # optional: bumps; and [shapes.opacity]: holes
    map = "dents.exr"                   # a file beside this one
    scale = 0.02

    [[shapes]]
    kind = "plane"
    point = [0.0, -1.0, 0.0]
    material = {model = "lambert", albedo = [0.5, 0.5, 0.5]}   # or mirror, glass

    [[lights]]
    kind = "directional"                # or ambient, point, environment
    direction = [-0.48, 0.6, 0.64]      # unit vector towards the light
    irradiance = [1.0, 1.0, 1.0]        # or one number; optional

    [shadows]                           # optional
    kind = "map"                        # or "rays"
    resolution = 1024

    [style]                             # optional
    kind = "gooch"
    steps = 4

The keys of a table are the attributes of the class it stands for, in `brdffit.scene`. A
shape without a material is made of what the scene is rendered with. A table
``provenance`` may stand beside these, in the sidecar of an image; it says where the
pixels came from and is no part of the scene.
"""

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import numpy as np
import tomli_w

from brdffit.catalogue import description, from_description
from brdffit.files import replacing
from brdffit.models import MODELS
from brdffit.models.base import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import check
from brdffit.scene.camera import Orthographic, Perspective
from brdffit.scene.lights import LIGHTS
from brdffit.scene.maps import Map
from brdffit.scene.materials import SMOOTH
from brdffit.scene.scene import Scene
from brdffit.scene.shadows import SHADOWS
from brdffit.scene.shapes import SHAPES
from brdffit.scene.sidecar import load_toml
from brdffit.scene.style import STYLES
from brdffit.scene.surface import HeightMap, OpacityMap
from brdffit.scene.triangles import Triangles

CAMERAS = {"orthographic": Orthographic, "perspective": Perspective}
SINGLE = {"camera": CAMERAS, "shadows": SHADOWS, "style": STYLES}
LISTS = {"shapes": SHAPES, "lights": LIGHTS}
INNER = {"height": HeightMap, "opacity": OpacityMap}
KIND_OF: dict[type[eqx.Module], str] = {
    made: kind
    for kinds in (*SINGLE.values(), *LISTS.values(), SMOOTH)
    for kind, made in kinds.items()
}
FILES = ("file", "map")  # keys whose value is a path
LONGEST = 1000  # characters of a path
MOST = 10_000  # lights or shapes


def load_scene(path: str | Path) -> Scene:
    """The scene described by a TOML file, or by the sidecar of an image.

    Files that it names are looked for beside it.

    Raises:
        OSError: The file, or one that it names, cannot be read.
        ValueError: The file is not TOML, or a key is unknown, missing or has a value
            that it cannot have; the message names file and key.
    """
    table = load_toml(path)
    try:
        return _scene(
            {key: table[key] for key in table if key != "provenance"},
            Path(path).parent,
        )
    except (ValueError, OSError) as error:
        raise type(error)(f"Scene `{path}`: {error}") from error


def save_scene(
    scene: Scene, path: str | Path, provenance: Mapping[str, Any] | None = None
) -> None:
    """Write a scene as a TOML file, with a table on where an image of it came from.

    Attributes that have their default value are left out.

    Raises:
        OSError: The file cannot be written.
        ValueError: The scene holds a map or a mesh that did not come from a file.
    """
    folder = Path(path).parent
    table: dict[str, Any] = {"exposure": scene.exposure, "tangents": scene.tangents}
    table |= {
        key: value
        for key, value in _table(scene, folder).items()
        if key not in (*table, *LISTS)
    }
    table |= {key: [_table(p, folder) for p in getattr(scene, key)] for key in LISTS}
    if provenance is not None:
        table["provenance"] = dict(provenance)
    with replacing(path) as temporary:
        temporary.write_text(tomli_w.dumps(table), encoding="utf-8")


def _scene(table: dict[str, Any], folder: Path) -> Scene:
    _check_keys(table, Scene)
    parts = dict(table)
    for key, kinds in LISTS.items():
        if not isinstance(table[key], list):
            raise ValueError(f"`{key}` must be a list of tables, written [[{key}]].")
        if len(table[key]) > MOST:
            raise ValueError(f"There must be at most {MOST} {key}.")
        parts[key] = tuple(
            _part(f"{key}[{index}]", part, kinds, folder)
            for index, part in enumerate(table[key])
        )
    for key, kinds in SINGLE.items():
        if key in table:
            parts[key] = _part(key, table[key], kinds, folder)
    return Scene(**parts)


def _part(place: str, table: Any, kinds: Mapping[str, Any], folder: Path) -> Any:
    """The camera, shape or light that one table of the file describes."""
    _require_table(place, table)
    if not isinstance(table.get("kind"), str):
        raise ValueError(f"`{place}` must say its `kind`: {' or '.join(kinds)}.")
    made = look_up(kinds, table["kind"], f"`kind` of `{place}`,")
    rest = {key: value for key, value in table.items() if key != "kind"}
    return _made(place, rest, made, folder)


def _made(place: str, table: dict[str, Any], made: Any, folder: Path) -> Any:
    """An object of a class from the table of its attributes."""
    try:
        _check_keys(table, made)
        inside = dict(table)
        for key, value in table.items():
            if key == "material":
                inside[key] = _material(value)
            elif key in INNER:
                _require_table(key, value)
                inside[key] = _made(key, value, INNER[key], folder)
            elif key in FILES:
                if not isinstance(value, str) or len(value) > LONGEST:
                    raise ValueError(f"`{key}` must name a file, but is {value!r:.60}.")
                inside[key] = folder / value
        return made(**inside)
    except (ValueError, OSError) as error:
        raise type(error)(f"in `{place}`, {error}") from error


def _material(table: Any) -> Any:
    """What a shape is made of, from its table."""
    _require_table("material", table)
    if not isinstance(table.get("model"), str):
        raise ValueError(
            "`material` must say its `model`: mirror, glass, or one of the catalogue."
        )
    known = SMOOTH | MODELS
    made = look_up(known, table["model"], "`model` of `material`,")
    if table["model"] in SMOOTH:
        rest = {key: value for key, value in table.items() if key != "model"}
        _check_keys(rest, made)
        return made(**rest)
    fields = {field.name: field for field in dataclasses.fields(made)}
    inner = table.get("parameters", {})
    _require_table("parameters", inner)
    for key in (*table, *inner):
        if key not in ("model", "parameters"):
            look_up(fields, key, "key")
    try:
        brdf = from_description(table)
    except TypeError as error:
        raise ValueError(f"`material` cannot be made: {error}.") from error
    check(brdf)
    return brdf


def _require_table(place: str, table: Any) -> None:
    if not isinstance(table, dict):
        raise ValueError(f"`{place}` must be a table, but is {table!r}.")


def _check_keys(table: Mapping[str, Any], made: Any) -> None:
    fields = {field.name: field for field in dataclasses.fields(made)}
    for key in table:
        look_up(fields, key, "key")
    for name, field in fields.items():
        if field.default is dataclasses.MISSING and name not in table:
            raise ValueError(f"key `{name}` is missing.")


def _table(part: eqx.Module, folder: Path) -> dict[str, Any]:
    """What makes a part again: its kind and what differs from the default."""
    table: dict[str, Any] = {}
    if type(part) in KIND_OF:
        name = "model" if KIND_OF[type(part)] in SMOOTH else "kind"
        table[name] = KIND_OF[type(part)]
    for field in dataclasses.fields(part):
        value = getattr(part, field.name)
        if value is not None and not _is_default(field, value):
            table[field.name] = _plain(value, folder)
    return table


def _plain(value: Any, folder: Path) -> Any:
    """A value as TOML can hold it."""
    if isinstance(value, Map | Triangles):
        if not value.file:
            raise ValueError(
                f"A scene with {value} cannot be written: save it as a file first, "
                "and name that in the scene."
            )
        return Path(os.path.relpath(value.file, folder)).as_posix()
    if isinstance(value, AbstractBRDF):
        return description(value)
    if isinstance(value, eqx.Module):
        return _table(value, folder)
    if isinstance(value, np.ndarray | jax.Array):
        return np.asarray(value, np.float64).tolist()
    return list(value) if isinstance(value, tuple) else value


def _is_default(field: dataclasses.Field, value: Any) -> bool:
    if field.default is dataclasses.MISSING:
        return False
    if isinstance(value, eqx.Module):
        return isinstance(field.default, eqx.Module) and bool(
            eqx.tree_equal(value, field.default)
        )
    default = (
        np.broadcast_to(field.default, np.shape(value))
        if (np.ndim(value) >= np.ndim(field.default))
        else field.default
    )
    return bool(np.array_equal(value, default))
