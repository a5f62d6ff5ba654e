"""Compilation with the options that make the programs of a fit small and fast."""

import functools
import weakref
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import jax
import numpy as np

from brdffit import executables
from brdffit.identity import NamelessError, identity, settings

Function = TypeVar("Function", bound=Callable)
Result = TypeVar("Result")

# The older fusion emitters of XLA's CPU compiler halve the time it takes and give a
# Gram matrix in a third of the time; vectors as wide as the processor has take another
# third off a pass over samples, where the default is half as wide (jaxlib 0.10). Speed
# only: where a later compiler does without them, or the device is another, so do we.
OPTIONS = {"xla_cpu_use_fusion_emitters": False, "xla_cpu_prefer_vector_width": 512}
# Elementwise loops are the faster by a third with the newer emitters.
ELEMENTWISE = {"xla_cpu_prefer_vector_width": 512}

MAPPINGS = 30_000  # of memory, at which programs are forgotten; see `make_room`


def compiled(
    function: Function,
    static: tuple[str, ...] = (),
    options: Mapping[str, Any] = OPTIONS,
) -> Function:
    """``jax.jit`` with these options, or without them where they are not known.

    Where the compilation cache is on, the whole executable is kept for later processes.
    The function cannot be called while another is traced.

    Args:
        function: What to compile.
        static: Arguments that are given by name and compiled in.
        options: Of the compiler.
    """
    return _Program(function, static, options)  # pyright: ignore[reportReturnType]


def make_room() -> None:
    """Forget all compiled programs when this process holds a great many.

    Each takes some mappings of memory, of which Linux gives a process 65,530. Without
    any left there is no memory, whatever is free, and the process comes to grief.
    """
    mappings = Path("/proc/self/maps")
    if mappings.exists() and mappings.read_bytes().count(b"\n") > MAPPINGS:
        for program in _programs:
            program.ready.clear()
        jax.clear_caches()


class _Program:
    """A function that is compiled when it is called, or found compiled."""

    def __init__(
        self, function: Callable, static: tuple[str, ...], options: Mapping[str, Any]
    ) -> None:
        functools.update_wrapper(self, function)
        self.function, self.static, self.options = function, static, options
        self.ready: dict[tuple, Callable] = {}
        self.jitted = _variants(function, static, options)
        # what JAX has compiled of a function it does not compile again, even where an
        # executable to keep is wanted, which must be new: so this is another function
        self.to_keep = _variants(functools.partial(function), static, options)
        _programs.add(self)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        if executables.store is None or _unusual():
            return _first_that_compiles(
                self.jitted, lambda jitted: jitted(*arguments, **named)
            )
        fixed = {name: named.pop(name) for name in self.static}
        leaves, tree = jax.tree.flatten((arguments, named))
        shapes = tuple(map(_shape, leaves))
        key = tree, shapes, tuple(fixed.values()), settings()
        if key not in self.ready:
            usual = functools.partial(self._called, fixed)
            kept = None if None in shapes else self._kept(arguments, named, fixed)
            self.ready[key] = kept or usual
        return self.ready[key](*arguments, **named)

    def _called(self, fixed: dict, *arguments: Any, **named: Any) -> Any:
        return _first_that_compiles(
            self.jitted, lambda jitted: jitted(*arguments, **named, **fixed)
        )

    def _kept(self, arguments: tuple, named: dict, fixed: dict) -> Callable | None:
        """The executable from disk, or else put there; None if that cannot be."""
        store = executables.store
        assert store is not None  # for the type checker
        try:
            compiled_in = fixed | {"options": dict(self.options)}
            name = identity(self.function, arguments, named, compiled_in)
        except NamelessError:
            return None
        found = store.load(name, (arguments, named))
        if found is None:
            with executables.without_cache():
                found = _first_that_compiles(
                    self.to_keep,
                    lambda jitted: jitted.lower(*arguments, **named, **fixed).compile(),
                )
            store.save(name, found)
        return found


_programs: weakref.WeakSet[_Program] = weakref.WeakSet()


def _variants(
    function: Callable, static: tuple[str, ...], options: Mapping[str, Any]
) -> list[Any]:
    """A function with the options of the compiler, and without."""
    tuned = jax.jit(function, static_argnames=static, compiler_options=dict(options))
    return [tuned, jax.jit(function, static_argnames=static)]


def _first_that_compiles(variants: list[Any], call: Callable[[Any], Result]) -> Result:
    """What a call gives, of the first variant that is left and compiles."""
    if len(variants) > 1:
        try:
            return call(variants[0])
        except jax.errors.JaxRuntimeError as error:
            if "compile option" not in str(error).lower():
                raise
            del variants[0]
    return call(variants[0])


def _unusual() -> bool:
    """Whether a program is to run elsewhere than usual, or not as one."""
    config: Any = jax.config  # its attributes are added at run time
    elsewhere = config.jax_default_device is not None or jax.default_backend() != "cpu"
    return elsewhere or config.jax_disable_jit


def _shape(leaf: Any) -> tuple | None:
    """Shape and type of an array on the first processor; None for anything else."""
    if isinstance(leaf, np.ndarray | np.generic):
        return leaf.shape, leaf.dtype
    if isinstance(leaf, jax.Array) and leaf.devices() == {jax.devices()[0]}:
        return leaf.shape, leaf.dtype, leaf.weak_type
    return None
