"""Compilation with the options that make the programs of a fit small and fast."""

from collections.abc import Callable
from functools import partial
from typing import TypeVar

import jax

Function = TypeVar("Function", bound=Callable)

# The older fusion emitters of XLA's CPU compiler halve the time it takes and give a
# Gram matrix in a third of the time; vectors as wide as the processor has take another
# third off a pass over samples, where the default is half as wide (jaxlib 0.10). Speed
# only: where a later compiler does without them, or the device is another, so do we.
OPTIONS = {"xla_cpu_use_fusion_emitters": False, "xla_cpu_prefer_vector_width": 512}


def compiled(function: Function, static: tuple[str, ...] = ()) -> Function:
    """``jax.jit`` with `OPTIONS`, or without them where they are not known."""
    plain = jax.jit(function, static_argnames=static)
    tuned = jax.jit(function, static_argnames=static, compiler_options=OPTIONS)
    return partial(_first_that_compiles, [tuned, plain])  # pyright: ignore


def _first_that_compiles(programs: list[Callable], *arguments, **options):
    if len(programs) > 1:
        try:
            return programs[0](*arguments, **options)
        except jax.errors.JaxRuntimeError as error:
            if "compile option" not in str(error).lower():
                raise
            del programs[0]
    return programs[0](*arguments, **options)
