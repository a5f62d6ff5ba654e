"""A surface to be fitted texel by texel: its stack, and where in an image they lie."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from brdffit.batch.maps import Layout
from brdffit.batch.photographs import source_of, write_stack
from brdffit.batch.stack import ZarrStack, import_zarr
from brdffit.names import look_up
from brdffit.readers.capture import matches, open_capture
from brdffit.samples import default_channels


@dataclasses.dataclass(frozen=True)
class Surface:
    """What is known of a surface besides the numbers of its texels.

    Attributes:
        name: What it is called.
        stack: Its texels.
        layout: Where they lie.
        photographs: Name of each observation.
        channels: Name of each channel.
        held_out: Index of the photograph that is not to be fitted, or None.
    """

    name: str
    stack: ZarrStack
    layout: Layout
    photographs: tuple[str, ...]
    channels: tuple[str, ...]
    held_out: int | None


def open_surface(source: Path, kept: Path, hold_out: str | None = None) -> Surface:
    """Open a zarr group of texels, or photographs, which are turned into one once.

    Args:
        source: Group as `brdffit.batch.stack` describes it, or folder of photographs as
            `brdffit.readers.capture` does.
        kept: Where the group of photographs is kept; it serves as long as they are the
            same.
        hold_out: Name of a photograph, or its number from 1.

    Raises:
        ValueError: It is neither, what it holds does not fit together, or there is no
            such photograph.
        OSError: Something cannot be read or written.
    """
    path, capture = source, None
    if source.is_dir() and matches(source):
        path, capture = kept, open_capture(source)
        names = capture.names
    elif (source / "zarr.json").is_file():
        count = len(ZarrStack(source).read(0, 1).value)
        names = _attributes(source).get("photographs") or _numbered(count)
    else:
        raise ValueError(
            f"`{source}` is neither a folder of photographs, which holds scene.toml or "
            "light_directions.txt, nor a zarr group of texels."
        )
    place = None if hold_out is None else _place(names, hold_out)
    if capture and not (
        kept.exists() and _attributes(kept).get("source") == source_of(capture)
    ):
        write_stack(capture, kept)
    stack = ZarrStack(path)
    group = import_zarr().open_group(path, mode="r")
    pixel = np.asarray(group["pixel"]) if "pixel" in group else np.arange(stack.texels)
    return Surface(
        source.resolve().name,
        stack,
        Layout(stack.shape or (1, stack.texels), pixel),
        tuple(names),
        tuple(_attributes(path).get("channels") or default_channels(stack.channels)),
        place,
    )


def _place(names: Sequence[str], wanted: str) -> int:
    """Index of a photograph."""
    if len(names) < 2:
        raise ValueError(
            "Of a single photograph none can be held out and another be fitted."
        )
    known = {name: n for n, name in enumerate(names)}
    if wanted not in known and wanted in _numbered(len(names)):
        return int(wanted) - 1
    return look_up(known, wanted, "Photograph")


def _numbered(count: int) -> list[str]:
    return [str(number + 1) for number in range(count)]


def _attributes(path: Path) -> dict[str, Any]:
    return dict(import_zarr().open_group(path, mode="r").attrs)
