"""A scene written as the TOML file that `brdffit.scene.files` reads."""

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import numpy as np
import tomli_w

from brdffit.catalogue import description
from brdffit.files import replacing
from brdffit.models.base import AbstractBRDF
from brdffit.scene.files import LISTS, SINGLE
from brdffit.scene.maps import Map
from brdffit.scene.materials import SMOOTH
from brdffit.scene.scene import Scene
from brdffit.scene.triangles import Triangles

KIND_OF: dict[type[eqx.Module], str] = {
    made: kind
    for kinds in (*SINGLE.values(), *LISTS.values(), SMOOTH)
    for kind, made in kinds.items()
}


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
