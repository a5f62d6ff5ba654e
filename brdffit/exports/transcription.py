"""A BRDF as straight-line code: its formula, traced by JAX, number by number.

So every model can be written in another language, and none is written twice. What does
not depend on directions is worked out once and becomes a constant.
"""

from collections.abc import Callable, Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.extend.core import ClosedJaxpr, Jaxpr, Literal

from brdffit.exports.program import (
    ARITHMETIC,
    INPUTS,
    Complex,
    Node,
    Program,
    as_complex,
    is_logical,
)
from brdffit.models import AbstractBRDF

SAME = {"copy", "copy_p", "stop_gradient", "optimization_barrier"}


def transcribe(brdf: AbstractBRDF) -> Program:
    """The statements that compute ``f_r`` of a BRDF.

    Raises:
        ValueError: It uses an operation that cannot be written out.
    """
    program = Program()
    given = np.array([program.input(name) for name in INPUTS], object)
    one = jnp.zeros(3, jnp.float32)
    traced = jax.make_jaxpr(brdf)(one, one)
    program.results = list(run(program, traced, [given[:3], given[3:]])[0])
    return program


def run(program: Program, closed: ClosedJaxpr, arguments: list[np.ndarray]) -> list:
    """Carry a traced function out on arrays of numbers and nodes."""
    jaxpr: Jaxpr = closed.jaxpr
    known: dict[Any, np.ndarray] = {}
    for variable, value in zip(jaxpr.constvars, closed.consts, strict=True):
        known[variable] = constants(value)
    known.update(zip(jaxpr.invars, arguments, strict=True))

    def read(atom: Any) -> np.ndarray:
        return constants(atom.val) if isinstance(atom, Literal) else known[atom]

    for equation in jaxpr.eqns:
        operands = [read(atom) for atom in equation.invars]
        results = step(program, equation, operands)
        known.update(zip(equation.outvars, results, strict=True))
    return [read(atom) for atom in jaxpr.outvars]


def constants(value: Any) -> np.ndarray:
    """An array of numbers, each by itself."""
    array = np.asarray(value)
    flat = [array.dtype.type(x) for x in array.ravel().tolist()]
    out = np.empty(len(flat), object)
    out[:] = flat
    return out.reshape(array.shape)


def step(program: Program, equation: Any, operands: list[np.ndarray]) -> list:
    """The outcome of one traced operation."""
    name, options = equation.primitive.name, equation.params
    inner = options.get("jaxpr") or options.get("call_jaxpr")
    if name in ("jit", "pjit", "closed_call", "custom_jvp_call") and inner is not None:
        return run(program, inner, operands)
    if name in SAME:
        return operands
    if name in SHAPES:
        return [SHAPES[name](operands, options)]
    shape = equation.outvars[0].aval.shape
    if name == "convert_element_type":
        kind = np.dtype(options["new_dtype"])
        return [each(lambda x: converted(program, x, kind), shape, operands[0])]
    if name == "select_n":
        which, no, yes = operands

        def chosen(condition, no, yes):
            if isinstance(no, Complex) or isinstance(yes, Complex):
                a, b = as_complex(yes), as_complex(no)
                return Complex(
                    chosen(condition, b.real, a.real), chosen(condition, b.imag, a.imag)
                )
            return program.apply("select", condition, yes, no)

        return [each(chosen, shape, which, no, yes)]
    if name == "integer_pow":
        return [each(lambda x: whole_power(x, options["y"]), shape, operands[0])]
    if name in COMPLEX:
        return [each(COMPLEX[name], shape, *operands)]
    if name in ("add", "sub", "mul", "div", "neg"):
        return [each(OPERATORS[name], shape, *operands)]
    if name in ARITHMETIC:

        def apply(*parts):
            if name == "abs" and isinstance(parts[0], Complex):
                z = parts[0]
                return program.apply("sqrt", z.real * z.real + z.imag * z.imag)
            return program.apply(name, *parts)

        return [each(apply, shape, *operands)]
    raise ValueError(
        f"This model cannot be written as plain statements: it needs the operation "
        f"`{name}`."
    )


def each(function: Callable[..., Any], shape: tuple[int, ...], *arrays) -> np.ndarray:
    """A function of every number of arrays."""
    out = np.empty(shape, object)
    wide = [np.broadcast_to(array, shape) for array in arrays]
    for place in np.ndindex(shape):
        out[place] = function(*(array[place] for array in wide))
    return out


def converted(program: Program, x: Any, kind: np.dtype) -> Any:
    """A number in another type; true and false become 1 and 0."""
    if kind.kind == "c":
        return as_complex(x)
    if is_logical(x) and kind.kind == "f":
        return program.apply("select", x, np.float32(1), np.float32(0))
    return x if isinstance(x, Node | Complex) else kind.type(x)


def whole_power(x: Any, power: int) -> Any:
    """A power by multiplication."""
    if power < 0:
        return np.float32(1) / whole_power(x, -power)
    if power == 1:
        return x
    half = whole_power(x, power // 2)
    return half * half if power % 2 == 0 else half * half * x


OPERATORS: Mapping[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
}
COMPLEX: Mapping[str, Callable[..., Any]] = {
    "complex": Complex,
    "real": lambda z: as_complex(z).real,
    "imag": lambda z: as_complex(z).imag,
    "conj": lambda z: Complex(as_complex(z).real, -as_complex(z).imag),
}


def broadcast(operands: list[np.ndarray], options: Mapping[str, Any]) -> np.ndarray:
    """JAX's ``broadcast_in_dim``."""
    (array,), shape = operands, options["shape"]
    thin = [1] * len(shape)
    for size, place in zip(array.shape, options["broadcast_dimensions"], strict=True):
        thin[place] = size
    return np.broadcast_to(array.reshape(thin), shape)


def product(operands: list[np.ndarray], options: Mapping[str, Any]) -> np.ndarray:
    """JAX's ``dot_general`` without batches."""
    (axes, _) = options["dimension_numbers"]
    return np.asarray(np.tensordot(*operands, axes=axes), object)


def part(operands: list[np.ndarray], options: Mapping[str, Any]) -> np.ndarray:
    """JAX's ``slice``."""
    strides = options["strides"] or [None] * operands[0].ndim
    ends = zip(options["start_indices"], options["limit_indices"], strides, strict=True)
    return operands[0][tuple(slice(*end) for end in ends)]


SHAPES: Mapping[str, Callable[[list[np.ndarray], Mapping[str, Any]], np.ndarray]] = {
    "broadcast_in_dim": broadcast,
    "dot_general": product,
    "slice": part,
    "squeeze": lambda x, o: np.asarray(x[0].squeeze(o["dimensions"]), object),
    "reshape": lambda x, o: x[0].reshape(o["new_sizes"]),
    "transpose": lambda x, o: x[0].transpose(o["permutation"]),
    "concatenate": lambda x, o: np.concatenate(x, axis=o["dimension"]),
    "stack": lambda x, o: np.stack(x, axis=o["axis"]),
    "reduce_sum": lambda x, o: np.asarray(x[0].sum(axis=tuple(o["axes"])), object),
}
