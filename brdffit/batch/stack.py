"""Stacks: the observations of many texels, read one range of them at a time.

On disk a stack is a zarr group. Its arrays have the texels last, and are chunked along
them only::

    value   (observation, channel, texel)            observed radiance
    wi, wo  (observation, 3, texel or 1)             directions in the texel's frame
    weight  (observation, channel or 1, texel or 1)  value = f_r * weight
    mask    (observation, channel or 1, texel or 1)  optional: false where unusable
    sigma   (observation, channel or 1, texel or 1)  optional: standard deviations

An axis of 1 is the same for all. The attribute ``shape``, rows and columns, says that
the texels are those of an image, row by row; or some of them, where an array ``pixel``
has the place of each in that order. For the names of the observations and channels,
`brdffit svbrdf` looks at the attributes ``photographs`` and ``channels``. Other arrays
and attributes do not matter.
"""

import dataclasses
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from brdffit.files import replacing
from brdffit.fit.texels import Texels

REQUIRED = ("value", "wi", "wo", "weight")
OPTIONAL = ("mask", "sigma")


@runtime_checkable
class Stack(Protocol):
    """Anything that texels can be read from, by several threads at once.

    On a cluster it is pickled, and must then be small: paths, not pixels.
    """

    @property
    def texels(self) -> int:
        """Number of texels."""
        ...

    @property
    def channels(self) -> int:
        """Number of channels."""
        ...

    @property
    def shape(self) -> tuple[int, int] | None:
        """Rows and columns, or None where the texels are not those of an image."""
        ...

    def read(self, start: int, stop: int) -> Texels:
        """The texels from one to before another."""
        ...


@dataclasses.dataclass(frozen=True)
class ZarrStack:
    """A zarr group, opened anew wherever it is unpickled.

    Raises:
        ValueError: It is no such group.
        OSError: It cannot be read.
    """

    path: Path

    def __post_init__(self) -> None:
        """Refuse what is no stack."""
        _ = self._arrays

    def __reduce__(self) -> tuple[Any, ...]:
        """Nothing but the path."""
        return ZarrStack, (self.path,)

    @cached_property
    def _group(self) -> Any:
        zarr = import_zarr()
        try:
            group = zarr.open_group(self.path, mode="r")
        except (OSError, ValueError) as error:
            raise ValueError(
                f"`{self.path}` must be a zarr group of texels."
            ) from error
        missing = [name for name in REQUIRED if name not in group]
        if missing:
            raise ValueError(
                f"Zarr group `{self.path}` must have the arrays {', '.join(REQUIRED)}, "
                f"but lacks {', '.join(missing)}."
            )
        return group

    @cached_property
    def _arrays(self) -> dict[str, Any]:
        names = (*REQUIRED, *OPTIONAL)
        return {name: self._group[name] for name in names if name in self._group}

    @property
    def texels(self) -> int:
        """Number of texels."""
        return self._arrays["value"].shape[-1]

    @property
    def channels(self) -> int:
        """Number of channels."""
        return self._arrays["value"].shape[1]

    @property
    def shape(self) -> tuple[int, int] | None:
        """Rows and columns, where the group says them."""
        shape = self._group.attrs.get("shape")
        return None if shape is None else tuple(shape)

    def read(self, start: int, stop: int) -> Texels:
        """The texels from one to before another."""
        return Texels(
            **{
                name: array[...] if array.shape[-1] == 1 else array[..., start:stop]
                for name, array in self._arrays.items()
            }
        )


@dataclasses.dataclass(frozen=True)
class TexelStack:
    """Texels that are in memory already."""

    all: Texels
    shape: tuple[int, int] | None = None

    @property
    def texels(self) -> int:
        """Number of texels."""
        return len(self.all)

    @property
    def channels(self) -> int:
        """Number of channels."""
        return self.all.channels

    def read(self, start: int, stop: int) -> Texels:
        """The texels from one to before another."""
        return Texels(
            **{
                name: array if array.shape[-1] == 1 else array[..., start:stop]
                for name, array in arrays_of(self.all).items()
            }
        )


def save_stack(
    path: str | Path, parts: Iterable[Texels], shape: tuple[int, int] | None = None
) -> ZarrStack:
    """Write texels as a zarr group, one chunk for each part, whole or not at all.

    Args:
        path: Of the group, which must not exist.
        parts: Consecutive texels, the same number in each but the last. What has a last
            axis of 1 is taken from the first part.
        shape: Rows and columns, if the texels are those of an image.

    Raises:
        OSError: It exists, or cannot be written.
    """
    zarr, path = import_zarr(), Path(path)
    if path.exists():
        raise FileExistsError(f"`{path}` exists: name another path for the stack.")
    with replacing(path) as temporary:
        attributes = {} if shape is None else {"shape": list(shape)}
        group = zarr.create_group(temporary, attributes=attributes)
        for number, part in enumerate(parts):
            for name, array in arrays_of(part).items():
                if number == 0:  # noise does not compress, and unpacking takes time
                    kind = {"chunks": array.shape, "compressors": None}
                    group.create_array(name, data=array, **kind)
                elif array.shape[-1] > 1 or len(part) == 1:
                    group[name].append(array, axis=2)
    return ZarrStack(path)


def arrays_of(texels: Texels) -> dict[str, np.ndarray]:
    """The arrays that texels have, by name."""
    found = {name: getattr(texels, name) for name in (*REQUIRED, *OPTIONAL)}
    return {name: np.asarray(a) for name, a in found.items() if a is not None}


def import_zarr() -> Any:
    """The package zarr.

    Raises:
        ValueError: It is not installed; the sentence says how to install it.
    """
    try:
        import zarr
    except ModuleNotFoundError as missing:
        raise ValueError(
            f"Textures need the package {missing.name}, which is not installed: "
            "pip install 'brdffit[cluster]'."
        ) from missing
    return zarr
