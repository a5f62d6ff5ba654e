"""Photographs of a surface turned into a stack of texels, a band of rows at a time.

A texel is a pixel of the mask that sees the surface and is not dark or saturated in all
photographs. The stack is a zarr group with `wi`, `wo`, `weight`, `value` and `mask` as
`brdffit.batch.stack` describes them, and with

- ``pixel (texels,)``: where each texel lies, counted row by row from the top left;
- attributes ``photographs``, ``channels`` (names) and ``source`` (a hash of all that
  the stack was made from).
"""

import hashlib
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jax
import numpy as np

from brdffit.batch.stack import import_zarr
from brdffit.effects import Plan
from brdffit.effects.plan import plan_for_tracing
from brdffit.readers import validity
from brdffit.readers.capture import Capture
from brdffit.render.geometry_pass import lit, meeting
from brdffit.samples import Samples
from brdffit.scene import Geometry, Hits

BAND = 2**14  # pixels at once, and texels in a chunk of the store
UNIT = 1e-2  # by how much the length of a normal may be off


def source_of(capture: Capture) -> str:
    """A hash of the files of a folder of photographs, and of the scene they show."""
    total = hashlib.sha256(str(jax.tree.structure(capture.scene)).encode())
    for leaf in jax.tree.leaves(capture.scene):
        total.update(np.asarray(leaf).tobytes())
    for path in sorted(capture.folder.iterdir()):
        if path.is_file():
            with path.open("rb") as stream:
                total.update(path.name.encode())
                total.update(hashlib.file_digest(stream, "sha256").digest())
    return total.hexdigest()


def write_stack(capture: Capture, path: Path) -> None:
    """Write the texels of photographs as a zarr group, whole or not at all.

    Args:
        capture: An open folder of photographs.
        path: Of the group; what is there is replaced.

    Raises:
        ValueError: No texel can be used, or a normal is no unit vector.
        OSError: A photograph is not complete, or the group cannot be written.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    made = not path.parent.exists()
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        group = import_zarr().create_group(temporary, overwrite=True)
        for arrays in _bands(capture):
            for name, array in arrays.items():
                _append(group, name, array)
        if "value" not in group:
            raise ValueError(
                f"Folder `{capture.folder}` holds no texel that can be used: all are "
                "masked, do not see the surface, or are dark or saturated in all "
                "photographs."
            )
        group.attrs.update(
            shape=list(capture.mask.shape),
            channels=list(capture.channels),
            photographs=capture.names,
            source=source_of(capture),
        )
        shutil.rmtree(path, ignore_errors=True)
        temporary.rename(path)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        if made and not path.exists():
            path.parent.rmdir()


def _append(group: Any, name: str, array: np.ndarray) -> None:
    """Add texels, which are the last axis, to an array of a group."""
    if name not in group:
        start = (*array.shape[:-1], 0)
        group.create_array(
            name, shape=start, chunks=(*start[:-1], BAND), dtype=array.dtype
        )
    group[name].append(array, axis=array.ndim - 1)


def _bands(capture: Capture) -> Iterator[dict[str, np.ndarray]]:
    """The arrays of the texels in each band of rows that has any."""
    rows, columns = capture.mask.shape
    channels = len(capture.channels)
    plan = plan_for_tracing(capture.scene, channels=channels)
    geometry = Geometry(capture.scene.shapes)
    height = max(BAND // columns, 1)
    for first in range(0, rows, height):
        last = min(first + height, rows)
        hits = _seen(capture, geometry, plan, first, last)
        if not len(hits.ray):
            continue
        samples = _lit(capture, geometry, plan, hits)
        arrays = _arrays(capture, samples, hits.ray, first, last)
        usable = arrays["mask"].any(axis=(0, 1))
        if usable.any():
            yield {name: array[..., usable] for name, array in arrays.items()}


def _seen(
    capture: Capture, geometry: Geometry, plan: Plan, first: int, last: int
) -> Hits:
    """What the wanted pixels of some rows see of the surface, with its normals."""
    columns = capture.mask.shape[1]
    pixel = np.flatnonzero(capture.mask[first:last]) + first * columns
    hits = meeting(geometry, plan)(*capture.scene.camera.rays(pixel))
    own = [shape.material is not None for shape in capture.scene.shapes]
    hits = hits.take(~np.array(own)[hits.shape])
    hits = hits._replace(ray=pixel[hits.ray])
    if capture.normals is None or not len(hits.ray):
        return hits
    here = hits.ray - first * columns
    normal = capture.normals(first, last).reshape(-1, 3)[here].astype(float)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    if not np.all(np.abs(length - 1) < UNIT):
        row, column = divmod(int(hits.ray[np.argmax(np.abs(length - 1))]), columns)
        raise ValueError(
            f"Normals in folder `{capture.folder}` must be unit vectors, but that of "
            f"row {row}, column {column} has length "
            f"{np.linalg.norm(normal[hits.ray == row * columns + column]):.4g}."
        )
    return hits._replace(normal=normal / length)


def _lit(capture: Capture, geometry: Geometry, plan: Plan, hits: Hits) -> Samples:
    """Samples of the hits under every light, their number filled up to a power of two.

    So few programs are compiled for many bands.
    """
    count = len(hits.ray)
    filled = np.minimum(np.arange(1 << (count - 1).bit_length()), count - 1)
    channels = len(capture.channels)
    samples = lit(capture.scene, geometry, hits.take(filled), plan, channels)
    return samples.take(np.arange(count))


def _arrays(
    capture: Capture, samples: Samples, pixel: np.ndarray, first: int, last: int
) -> dict[str, np.ndarray]:
    """Directions, weights and values with the texel last, as a stack has them."""
    columns = capture.mask.shape[1]
    wi = np.moveaxis(np.asarray(samples.wi), 0, -1)
    wo = np.broadcast_to(np.asarray(samples.wo).T, wi.shape)
    weight = np.moveaxis(np.asarray(samples.weight), 0, -1)
    if capture.scene.channels is None:  # all channels alike
        weight = weight[:, :1]
    here = pixel - first * columns
    value = np.empty((len(wi), len(capture.channels), len(pixel)), np.float32)
    mask = np.empty(value.shape, bool)
    for number, photograph in enumerate(capture.photographs):
        band = photograph.rows(first, last)
        shown = band.reshape(-1, band.shape[-1])[here].T
        mask[number] = np.isfinite(shown) & (shown < photograph.full)
        value[number] = shown * np.float32(capture.radiance)
    mask &= weight > 0
    mask &= validity.above_horizon(np.asarray(samples.wo))
    return {
        "pixel": pixel,
        "wi": wi,
        "wo": wo,
        "weight": weight,
        "value": np.where(mask, value, np.float32(0)),
        "mask": mask,
    }
