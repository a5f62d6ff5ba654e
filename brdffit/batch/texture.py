"""Textures: a model fitted to every texel of a stack, one chunk of them at a time.

A run leaves in its folder

- ``fits.zarr``, a zarr group with ``parameters/NAME`` and ``standard_errors/NAME``
  (channel or 1, texel), ``rms``, ``converged``, ``steps`` and ``at_bound`` (texel);
- ``ledger.jsonl``, by which a later run knows what is finished.

A chunk of the run is one chunk of each of these arrays, so no two tasks ever write the
same file. Memory is that of one chunk for each thread, however many texels there are.
"""

import dataclasses
import hashlib
from collections.abc import Callable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from brdffit.batch.ledger import Record, fingerprint, open_ledger, seal
from brdffit.batch.run import Outcome, run
from brdffit.batch.stack import Stack, TexelStack, ZarrStack, arrays_of, import_zarr
from brdffit.batch.tally import Tally
from brdffit.catalogue import description, from_description, from_name
from brdffit.files import replacing
from brdffit.fit import RESIDUALS
from brdffit.fit.conditions import Numbers, held_values
from brdffit.fit.texels import TexelFits, Texels
from brdffit.fit.texture import fit_texels
from brdffit.fit.transforms import Layout
from brdffit.models import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import registry_name

FITS = "fits.zarr"
CHUNK = 65_536  # texels; some 60 MB of 24 observations in RGB with their directions
KINDS = {"rms": "float32", "converged": "bool", "steps": "int32", "at_bound": "bool"}


@dataclasses.dataclass(frozen=True)
class Chunk:
    """A range of texels, and what an earlier run recorded about it."""

    number: int
    start: int
    stop: int
    record: Record | None


@dataclasses.dataclass(frozen=True)
class FitChunk:
    """Fits a model to a chunk; the task that threads and workers are given.

    Attributes:
        group: Of the results.
        stack: Where the texels come from.
        model: Description of the model; see `brdffit.catalogue`.
        residual: What is compared.
        fixed: Parameters to hold, with their values.
    """

    group: Path
    stack: Stack
    model: dict[str, Any]
    residual: str | None
    fixed: dict[str, Any]

    def __call__(self, chunk: Chunk) -> Outcome:
        """Keep what still holds, or else fit."""
        key, count = str(chunk.number), chunk.stop - chunk.start
        texels = self.stack.read(chunk.start, chunk.stop)
        mark = fingerprint(content=content_of(texels), **self.options)
        arrays = open_results(self.group)
        files = files_of(self.group, arrays, chunk.number)
        if chunk.record and chunk.record.holds(mark, files):
            return Outcome(key, count, chunk.record, kept=True)
        fits = fit_texels(
            from_description(self.model),
            texels,
            residual=self.residual,
            fixed=self.fixed,
            threads=2,  # so that a core never waits; chunks are shared among the cores
        )
        for name, values in _results(fits).items():
            arrays[name][..., chunk.start : chunk.stop] = values
        facts = {"not_converged": int(np.count_nonzero(~fits.converged))}
        return Outcome(key, count, Record(key, mark, seal(files), facts))

    @property
    def options(self) -> dict[str, Any]:
        """What, beside the texels, decides the results."""
        return {"model": self.model, "residual": self.residual, "fixed": self.fixed}


def fit_texture(
    model: str | AbstractBRDF,
    stack: str | Path | Stack | Texels,
    out: str | Path,
    *,
    residual: str | None = None,
    fixed: Mapping[str, Numbers] | None = None,
    resume: bool = False,
    cluster: str | None = None,
    chunk: int = CHUNK,
    on_progress: Callable[[Tally], None] | None = None,
) -> Tally:
    """Fit a model to every texel of a stack.

    Args:
        model: Name of a model or of a sum; or a model, whose options count.
        stack: Path of a zarr group, as `brdffit.batch.stack` describes it, something
            else that can be read in ranges, or texels in memory.
        out: Folder of the run, made if it is not there.
        residual: What is compared; the default of `fit_texels` where None.
        fixed: Parameters to hold in all texels, with their values.
        resume: Whether to go on with an earlier run in that folder, whose chunks are
            kept where texels, model, options and version are the same and their
            checksum is right.
        cluster: Address of a Dask scheduler, whose workers see the same files under the
            same names; by default threads of this process.
        chunk: Number of texels that are fitted, written and recorded together.
        on_progress: Called after every chunk.

    Returns:
        How many texels were kept, done, and did not converge.

    Raises:
        ValueError: An unknown model or residual, a parameter outside its interval, a
            stack that is none, or an earlier run of another layout.
        FileExistsError: The folder holds something and is not to be resumed.
        BlockingIOError: Another run has the folder.
        ConnectionError: The scheduler is not there, or went away.
        OSError: Something cannot be read or written.
        KeyboardInterrupt: The run was interrupted; says how to go on.
    """
    import_zarr()
    source = _opened(stack)
    brdf = from_name(model, source.channels) if isinstance(model, str) else model
    if residual:
        look_up(RESIDUALS, residual, "Residual")
    held = {name: np.asarray(v, float).tolist() for name, v in (fixed or {}).items()}
    held_values(Layout.of(brdf), held, registry_name(brdf))
    if chunk < 1:
        raise ValueError(f"`chunk` must be 1 or above, but is {chunk}.")
    folder, texels = Path(out).absolute(), source.texels
    task = FitChunk(folder / FITS, source, description(brdf), residual, held)
    with open_ledger(folder, resume) as ledger:
        _prepare(task, brdf, chunk)
        chunks = (
            Chunk(
                number,
                start,
                min(start + chunk, texels),
                ledger.records.get(str(number)),
            )
            for number, start in enumerate(range(0, texels, chunk))
        )
        tally = Tally("texels", texels)
        for _ in run(task, chunks, ledger, tally, cluster, on_progress):
            pass
    return tally


def content_of(texels: Texels) -> str:
    """Hash of the numbers of texels, and of how they are laid out."""
    total = hashlib.sha256()
    for name, array in arrays_of(texels).items():
        total.update(f"{name} {array.shape} {array.dtype}".encode())
        total.update(np.ascontiguousarray(array).data)
    return total.hexdigest()


def _opened(stack: str | Path | Stack | Texels) -> Stack:
    if isinstance(stack, str | Path):
        return ZarrStack(Path(stack).absolute())
    return TexelStack(stack) if isinstance(stack, Texels) else stack


def _prepare(task: FitChunk, brdf: AbstractBRDF, chunk: int) -> None:
    """Make the group of the results, or check that the one there is of this kind."""
    zarr, stack = import_zarr(), task.stack
    layout = {"model": registry_name(brdf), "channels": stack.channels}
    layout |= {"texels": stack.texels, "chunk": chunk}
    layout["shape"] = None if stack.shape is None else list(stack.shape)
    origin = {"fingerprint": fingerprint(**task.options), "brdffit": version("brdffit")}
    if not task.group.exists():
        with replacing(task.group) as temporary:
            group = zarr.create_group(temporary, attributes=layout | origin)
            _create_arrays(group, Layout.of(brdf), stack.texels, chunk)
        return
    attributes = zarr.open_group(task.group, mode="r+").attrs
    for name, wanted in layout.items():
        if attributes[name] != wanted:
            raise ValueError(
                f"Folder `{task.group.parent}` holds a run with {name} "
                f"{attributes[name]}, not {wanted}: name another folder."
            )
    attributes.update(origin)
    for unfinished in task.group.rglob("*.partial"):  # of a run that was killed
        unfinished.unlink()


def _create_arrays(group: Any, layout: Layout, texels: int, chunk: int) -> None:
    """Arrays of the results, whose chunks are those of the run."""

    def create(name: str, leading: tuple[int, ...], kind: str) -> None:
        group.create_array(
            name,
            shape=(*leading, texels),
            chunks=(*leading, chunk),
            dtype=kind,
            fill_value=np.nan if kind == "float32" else 0,
        )

    for name, places in layout.places.items():
        create(f"parameters/{name}", (len(places),), "float32")
        create(f"standard_errors/{name}", (len(places),), "float32")
    for name, kind in KINDS.items():
        create(name, (), kind)


def open_results(path: Path) -> dict[str, Any]:
    """Arrays of the results by name, in one order; chunks of zeros are written too."""
    group = import_zarr().open_group(path, mode="r+")
    parts = [(f"{part}/", group[part]) for part in ("parameters", "standard_errors")]
    names = [f"{prefix}{name}" for prefix, part in parts for name in sorted(part)]
    whole = {"write_empty_chunks": True}
    return {name: group[name].with_config(whole) for name in [*names, *KINDS]}


def files_of(path: Path, arrays: Mapping[str, Any], number: int) -> list[Path]:
    """The file of a chunk in each of the arrays of the results."""
    found = []
    for name, array in arrays.items():
        place = (*(0 for _ in array.shape[:-1]), number)
        found.append(path / name / array.metadata.encode_chunk_key(place))
    return found


def _results(fits: TexelFits) -> dict[str, np.ndarray]:
    """What was found, by the names of the arrays that hold it."""
    found = {f"parameters/{name}": v for name, v in fits.parameters.items()}
    found |= {f"standard_errors/{name}": v for name, v in fits.standard_errors.items()}
    return found | {name: getattr(fits, name) for name in KINDS}
