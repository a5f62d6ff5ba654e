"""Straight-line code: numbers, operations on them, and their meaning."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import scipy.special

from brdffit.types import Values, Vectors

ARITHMETIC = {
    "add": "({} + {})",
    "sub": "({} - {})",
    "mul": "({} * {})",
    "div": "({} / {})",
    "neg": "(-{})",
    "max": "max({}, {})",
    "min": "min({}, {})",
    "abs": "abs({})",
    "sqrt": "sqrt({})",
    "exp": "exp({})",
    "exp2": "exp2({})",
    "log": "log({})",
    "log1p": "log1p({})",
    "pow": "pow({}, {})",
    "sinh": "sinh({})",
    "tanh": "tanh({})",
    "asinh": "asinh({})",
    "sin": "sin({})",
    "cos": "cos({})",
    "acos": "acos({})",
    "erf": "erf({})",
    "floor": "floor({})",
    "ceil": "ceil({})",
    "gt": "({} > {})",
    "ge": "({} >= {})",
    "lt": "({} < {})",
    "le": "({} <= {})",
    "eq": "({} == {})",
    "ne": "({} != {})",
    "and": "({} && {})",
    "or": "({} || {})",
    "not": "(!{})",
    "select": "({} ? {} : {})",
}
LOGICAL = {"gt", "ge", "lt", "le", "eq", "ne", "and", "or", "not"}
ZERO = np.float32(0)
INPUTS = ("wi.x", "wi.y", "wi.z", "wo.x", "wo.y", "wo.z")


class Node:
    """A number that depends on directions, known by its place in a program."""

    __array_ufunc__ = None  # numpy's numbers leave arithmetic to this class

    def __init__(self, program: "Program", place: int):
        """The outcome of a statement of a program."""
        self.program, self.place = program, place

    def __add__(self, other):
        return self.program.apply("add", self, other)

    def __radd__(self, other):
        return self.program.apply("add", other, self)

    def __sub__(self, other):
        return self.program.apply("sub", self, other)

    def __rsub__(self, other):
        return self.program.apply("sub", other, self)

    def __mul__(self, other):
        return self.program.apply("mul", self, other)

    def __rmul__(self, other):
        return self.program.apply("mul", other, self)

    def __truediv__(self, other):
        return self.program.apply("div", self, other)

    def __rtruediv__(self, other):
        return self.program.apply("div", other, self)

    def __neg__(self):
        return self.program.apply("neg", self)


class Complex:
    """A complex number as two real ones."""

    __array_ufunc__ = None

    def __init__(self, real: Any, imaginary: Any = ZERO):
        """Real and imaginary part."""
        self.real, self.imag = real, imaginary

    def __add__(self, other):
        other = as_complex(other)
        return Complex(self.real + other.real, self.imag + other.imag)

    def __sub__(self, other):
        other = as_complex(other)
        return Complex(self.real - other.real, self.imag - other.imag)

    def __mul__(self, other):
        other = as_complex(other)
        return Complex(
            self.real * other.real - self.imag * other.imag,
            self.real * other.imag + self.imag * other.real,
        )

    def __radd__(self, other):
        return as_complex(other) + self

    def __rsub__(self, other):
        return as_complex(other) - self

    def __rmul__(self, other):
        return as_complex(other) * self

    def __neg__(self):
        return Complex(-self.real, -self.imag)


def as_complex(value: Any) -> Complex:
    """A number as a complex one."""
    if isinstance(value, Complex):
        return value
    if isinstance(value, np.complexfloating | complex):
        return Complex(np.float32(value.real), np.float32(value.imag))
    return Complex(value)


class Program:
    """Statements in the order in which they can be carried out.

    Attributes:
        statements: Operation and operands of each; an operand is a `Node` or a number.
        logical: Whether each gives true or false.
        results: What the program computes.
    """

    def __init__(self):
        """A program without statements."""
        self.statements: list[tuple[str, tuple[Any, ...]]] = []
        self.results: list[Any] = []
        self.logical: list[bool] = []
        self._known: dict[Any, Node] = {}

    def input(self, name: str) -> "Node":
        """A number that is given when the program is carried out."""
        return self._add("input", (name,), False)

    def _add(self, operation: str, operands: tuple[Any, ...], logical: bool) -> "Node":
        self.statements.append((operation, operands))
        self.logical.append(logical)
        return Node(self, len(self.statements) - 1)

    def apply(self, operation: str, *operands: Any) -> Any:
        """The outcome of an operation: a constant, what is known already, or new."""
        if operation == "select" and not isinstance(operands[0], Node):
            return operands[1] if operands[0] else operands[2]
        if not any(isinstance(x, Node) for x in operands):
            with np.errstate(all="ignore"):
                return np_function(operation)(*operands)
        key = (
            operation,
            *(x.place if isinstance(x, Node) else ("", x) for x in operands),
        )
        if key not in self._known:
            logical = operation in LOGICAL
            if operation == "select":
                logical = all(is_logical(x) for x in operands[1:])
            self._known[key] = self._add(operation, operands, logical)
        return self._known[key]

    def __call__(self, wi: Vectors, wo: Vectors) -> Values:
        """Carry the program out for directions ``(N, 3)``, in single precision."""
        given = dict(zip(INPUTS, np.hstack([wi, wo]).astype(np.float32).T, strict=True))
        done: list[Any] = []

        def value(x: Any) -> Any:
            return done[x.place] if isinstance(x, Node) else x

        with np.errstate(all="ignore"):
            for operation, operands in self.statements:
                if operation == "input":
                    done.append(given[operands[0]])
                else:
                    done.append(np_function(operation)(*map(value, operands)))
        found = [np.broadcast_to(value(x), len(wi)) for x in self.results]
        return np.stack(found, axis=1).astype(np.float32)


def is_logical(x: Any) -> bool:
    """Whether a number is true or false."""
    if isinstance(x, Node):
        return x.program.logical[x.place]
    return isinstance(x, bool | np.bool_)


def np_function(operation: str) -> Callable[..., Any]:
    """An operation on numpy's numbers."""
    names: Mapping[str, Any] = {
        "add": np.add,
        "sub": np.subtract,
        "mul": np.multiply,
        "div": np.divide,
        "neg": np.negative,
        "max": np.maximum,
        "min": np.minimum,
        "pow": np.power,
        "acos": np.arccos,
        "asinh": np.arcsinh,
        "erf": scipy.special.erf,
        "gt": np.greater,
        "ge": np.greater_equal,
        "lt": np.less,
        "le": np.less_equal,
        "eq": np.equal,
        "ne": np.not_equal,
        "and": np.logical_and,
        "or": np.logical_or,
        "not": np.logical_not,
        "select": np.where,
    }
    return names.get(operation) or getattr(np, operation)


def literal(x: Any) -> str:
    """A constant as it is written.

    Raises:
        ValueError: It is not a number.
    """
    if isinstance(x, bool | np.bool_):
        return "true" if x else "false"
    number = float(x)
    if math.isnan(number):
        raise ValueError("This model has a constant that is not a number.")
    number = min(max(number, -float(np.finfo(np.float32).max)), 3.4028234e38)
    with np.printoptions(legacy=False):
        text = str(np.float32(number))
    return text if set(text) & set(".e") else f"{text}.0"
