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
shape without a material is made of what the scene is rendered with; the material of one
whose channels differ is ``{per_channel = [...]}``, with a model for each. A table
``provenance`` may stand beside these, in the sidecar of an image; it says where the
pixels came from and is no part of the scene.
"""

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from brdffit.catalogue import from_description
from brdffit.models import MODELS
from brdffit.models.base import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import check
from brdffit.per_channel import PerChannel
from brdffit.scene import values
from brdffit.scene.camera import Orthographic, Perspective
from brdffit.scene.lights import LIGHTS
from brdffit.scene.materials import SMOOTH
from brdffit.scene.scene import Scene
from brdffit.scene.shadows import SHADOWS
from brdffit.scene.shapes import SHAPES
from brdffit.scene.sidecar import load_toml
from brdffit.scene.style import STYLES
from brdffit.scene.surface import HeightMap, OpacityMap

CAMERAS = {"orthographic": Orthographic, "perspective": Perspective}
SINGLE = {"camera": CAMERAS, "shadows": SHADOWS, "style": STYLES}
LISTS = {"shapes": SHAPES, "lights": LIGHTS}
INNER = {"height": HeightMap, "opacity": OpacityMap}
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
            elif key in INNER and made in SHAPES.values():  # a camera has a height, too
                _require_table(key, value)
                inside[key] = _made(key, value, INNER[key], folder)
            elif key in FILES:
                inside[key] = _file(key, value, folder)
        return made(**inside)
    except (ValueError, OSError) as error:
        raise type(error)(f"in `{place}`, {error}") from error


def _file(key: str, value: Any, folder: Path) -> Path:
    """The file that a key names, beside the scene."""
    if not isinstance(value, str) or len(value) > LONGEST:
        raise ValueError(f"`{key}` must name a file, but is {value!r:.60}.")
    if os.path.isdir(path := folder / value):  # also where no name can be
        raise ValueError(f"`{key}` must name a file, but `{path}` is a folder.")
    return path


def _material(table: Any) -> Any:
    """What a shape is made of, from its table."""
    _require_table("material", table)
    if "per_channel" in table:
        return _per_channel(**table)
    made = _model("material", table, SMOOTH | MODELS)
    if table["model"] not in SMOOTH:
        return _brdf("material", table)
    rest = {key: value for key, value in table.items() if key != "model"}
    _check_keys(rest, made)
    return made(**rest)


def _per_channel(per_channel: Any, **others: Any) -> PerChannel:
    """A material that has a model for each channel."""
    for key in others:
        raise ValueError(f"`material` must have no `{key}` beside `per_channel`.")
    if not isinstance(per_channel, list):
        raise ValueError(
            "`per_channel` must be a list of tables, for each channel one."
        )
    parts = enumerate(per_channel)
    return PerChannel(tuple(_brdf(f"per_channel[{n}]", part) for n, part in parts))


def _brdf(place: str, table: Any) -> AbstractBRDF:
    """A BRDF from the table of its values."""
    _check_brdf(table, _model(place, table, MODELS))
    brdf = from_description(table)
    check(brdf)
    return brdf


def _model(place: str, table: Any, known: Mapping[str, Any]) -> Any:
    """The class that a table says it is made by."""
    _require_table(place, table)
    if not isinstance(table.get("model"), str):
        smooth = "mirror, glass, or " if known is not MODELS else ""
        raise ValueError(
            f"`{place}` must say its `model`: {smooth}one of the catalogue."
        )
    return look_up(known, table["model"], f"`model` of `{place}`,")


def _check_brdf(table: dict[str, Any], made: Any) -> None:
    """Refuse values that no model takes, with their key; parts of a sum alike."""
    fields = {field.name: field for field in dataclasses.fields(made)}
    inner = table.get("parameters", {})
    _require_table("parameters", inner)
    for key, value in (table | inner).items():
        if key in ("model", "parameters"):
            continue
        field = look_up(fields, key, "key")
        if field.type is AbstractBRDF:
            _check_brdf(value, _model(key, value, MODELS))
        elif field.metadata.get("static"):
            values.boolean(key, value)
        else:
            values.finite(key, value)


def _require_table(place: str, table: Any) -> None:
    if not isinstance(table, dict):
        raise ValueError(f"`{place}` must be a table, but is {table!r}.")


def _check_keys(table: Mapping[str, Any], made: Any) -> None:
    fields = {field.name: field for field in dataclasses.fields(made)}
    for key in table:
        if not fields:
            raise ValueError(f"key `{key}` is none: this kind has no keys.")
        look_up(fields, key, "key")
    for name, field in fields.items():
        if field.default is dataclasses.MISSING and name not in table:
            raise ValueError(f"key `{name}` is missing.")
