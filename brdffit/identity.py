"""What a compiled program depends on, in one name that other processes give it too.

Strict: where a part has no such name, as a function made while a program runs or
a class from outside this package, the whole has none.
"""

import dataclasses
import hashlib
import os
import platform
import sys
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import numpy as np

SETTINGS = (  # of JAX, which change what it traces and compiles
    "jax_enable_x64",
    "jax_default_matmul_precision",
    "jax_numpy_dtype_promotion",
    "jax_default_prng_impl",
    "jax_threefry_partitionable",
    "jax_num_cpu_devices",
    "jax_optimization_level",
    "jax_exec_time_optimization_effort",
)
LIBRARIES = ("jax", "jaxlib", "equinox", "optimistix", "lineax", "numpy")
PLAIN = (type(None), bool, int, float, complex, str, bytes)
HEAD = 16384  # bytes of the description of the first processor


class NamelessError(Exception):
    """Something has no name that another process would give it too."""


def identity(
    function: Callable,
    arguments: tuple[Any, ...],
    named: Mapping[str, Any],
    fixed: Mapping[str, Any],
) -> str:
    """Name of a program: equal where everything that it depends on is equal.

    That is the code of this package and of what it is written with, the processor, the
    settings of JAX, and the arguments.

    Args:
        function: What is compiled.
        arguments: What it is called with; of arrays only shape and type count.
        named: The same by name.
        fixed: What is compiled in, such as options: values count.

    Returns:
        64 hexadecimal digits.

    Raises:
        NamelessError: Something of it has no name.
    """
    parts = (
        _surroundings(),
        settings(),
        _place(function),
        _described([arguments, dict(named)], fixed=False),
        _described(dict(fixed), fixed=True),
    )
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def settings() -> tuple[Any, ...]:
    """The settings of JAX that matter, as they are here and now."""
    return tuple(getattr(jax.config, name, None) for name in SETTINGS)


def _described(value: Any, fixed: bool) -> Any:
    """A value in strings and tuples; an array by shape and type, unless it is fixed."""
    kind = type(value)
    if kind in PLAIN:
        return kind.__name__, repr(value)
    if isinstance(value, tuple | list):
        name = kind.__name__ if kind in (tuple, list) else _place(kind)
        return name, tuple(_described(item, fixed) for item in value)
    if kind is dict:
        items = sorted(value.items())
        return "dict", tuple((repr(k), _described(v, fixed)) for k, v in items)
    if isinstance(value, np.generic) and fixed:
        return str(value.dtype), repr(value.item())
    if isinstance(value, jax.Array | np.ndarray | np.generic) and not fixed:
        weak = getattr(value, "weak_type", False)
        return "array", value.shape, str(value.dtype), weak
    if isinstance(value, type) or not dataclasses.is_dataclass(value):
        return _place(value)
    if not isinstance(value, eqx.Module):  # for JAX one thing, not a tree of arrays
        fixed = True
    fields = tuple(
        _described(getattr(value, field.name), fixed or "static" in field.metadata)
        for field in dataclasses.fields(value)
    )
    return _place(kind), fields


def _place(thing: Any) -> str:
    """Where in this package a function or class is found."""
    module = getattr(thing, "__module__", None) or ""
    path = getattr(thing, "__qualname__", "")
    found: Any = sys.modules.get(module)
    for part in path.split("."):
        found = getattr(found, part, None)
    ours = module.partition(".")[0] == __name__.partition(".")[0]
    if not ours or (found is not thing and thing is not _bare(found)):
        raise NamelessError(f"`{thing!r}` has no name that another process gives it.")
    return f"{module}:{path}"


def _bare(function: Any) -> Any:
    """What a decorated function was before."""
    return getattr(function, "__wrapped__", None)


@cache
def _surroundings() -> tuple[Any, ...]:
    """Code, libraries, processor and flags, which stay while a process runs."""
    flags = [item for item in os.environ.items() if item[0][:4] in ("JAX_", "XLA_")]
    return (
        _sources(Path(__file__).parent),
        [(name, version(name)) for name in LIBRARIES],
        (platform.system(), platform.python_version(), platform.machine()),
        _processor(),
        sorted(flags),
    )


def _sources(folder: Path) -> list[tuple[str, int, int]]:
    """Every source file of the package with its size and the time of its change."""
    found = []
    for where, _, names in os.walk(folder):
        for name in names:
            if name.endswith(".py"):
                path = os.path.join(where, name)
                state = os.stat(path)
                found.append((path, state.st_size, state.st_mtime_ns))
    return sorted(found)


def _processor() -> str:
    """What the processor can do, or else which one it is."""
    try:
        with open("/proc/cpuinfo") as description:
            lines = description.read(HEAD).splitlines()
        return next(line for line in lines if line.startswith(("flags", "Features")))
    except (OSError, StopIteration):
        return f"{platform.processor()} of {platform.node()}"
