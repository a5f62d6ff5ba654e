"""What is known about a model parameter: range, typical range, unit, symbol, role.

A model declares each parameter once, as a field; bounds for the solver, starts, labels
of plots, columns of tables and options of the command line are all read from here.
"""

import dataclasses
from collections.abc import Mapping
from operator import attrgetter
from typing import Any, TypeVar

import equinox as eqx
import jax
import jax.core
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from brdffit.types import AnyArray

Model = TypeVar("Model", bound=eqx.Module)


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A closed interval of legal values, with what a fit needs to know about it.

    Attributes:
        lower: Smallest legal value.
        upper: Largest legal value.
        typical: Interval of everyday values, where starts and random truths are drawn.
        unit: Unit, ``"1"`` when dimensionless.
        symbol: LaTeX symbol in the formula of the model.
        spectral: True for one value per channel, False for one value in all.
        linear: True when ``f_r`` is jointly affine in this and all other linear
            parameters.
        logarithmic: True when a solver should move in the logarithm of the value.
    """

    lower: float
    upper: float
    typical: tuple[float, float]
    unit: str
    symbol: str
    spectral: bool
    linear: bool
    logarithmic: bool

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"[{self.lower:g}, {self.upper:g}]{unit}"


def parameter(
    default: float,
    *,
    bounds: tuple[float, float],
    typical: tuple[float, float],
    symbol: str,
    unit: str = "1",
    spectral: bool = False,
    linear: bool = False,
    logarithmic: bool = False,
) -> Any:
    """Declare a model field that can be fitted; see `Parameter` for the meaning."""
    return eqx.field(
        default=default,
        converter=as_float,
        metadata={
            "parameter": Parameter(
                *bounds, typical, unit, symbol, spectral, linear, logarithmic
            )
        },
    )


def known(default: float, *, unit: str, symbol: str) -> Any:
    """Declare a model field with one value per channel that is given, never fitted."""
    return eqx.field(
        default=default, converter=as_float, metadata={"known": (unit, symbol)}
    )


def spectral_fields(model: eqx.Module | type[eqx.Module]) -> dict[str, bool]:
    """Own numeric fields of a model: True for one value per channel, False for one."""
    return {
        field.name: "known" in field.metadata or field.metadata["parameter"].spectral
        for field in dataclasses.fields(model)
        if field.metadata.keys() & {"known", "parameter"}
    }


def as_float(value: Any) -> Array:
    """``value`` as an array of floats; the precision of a float array is kept."""
    if isinstance(value, int | float | np.ndarray | np.generic):  # compiles nothing
        value = np.asarray(value)
        known = jnp.issubdtype(value.dtype, jnp.floating)
        return jax.device_put(value if known else value.astype(float))
    dtype = jnp.result_type(jnp.asarray(value))
    return jnp.asarray(value, dtype if jnp.issubdtype(dtype, jnp.floating) else float)


def broadcast(array: AnyArray, shape: tuple[int, ...]) -> Array:
    """``array`` in a wider shape, which compiles nothing unless it is being traced."""
    if isinstance(array, jax.core.Tracer):
        return jnp.broadcast_to(array, shape)
    return jax.device_put(np.broadcast_to(np.asarray(array), shape))


def parameters(model: eqx.Module | type[eqx.Module]) -> dict[str, Parameter]:
    """Parameters of a model by dotted name, parts of a composite included."""
    found = {}
    for field in dataclasses.fields(model):
        if "parameter" in field.metadata:
            found[field.name] = field.metadata["parameter"]
        elif isinstance(part := getattr(model, field.name, None), eqx.Module):
            for name, known in parameters(part).items():
                found[f"{field.name}.{name}"] = known
    return found


def values(model: eqx.Module) -> dict[str, Array]:
    """Current value of each parameter, by dotted name."""
    return {name: attrgetter(name)(model) for name in parameters(model)}


def replace(model: Model, new: Mapping[str, Any]) -> Model:
    """Copy of a model with the named parameters changed; no check is made."""
    return eqx.tree_at(
        lambda m: [attrgetter(name)(m) for name in new], model, list(new.values())
    )


def check(model: eqx.Module) -> None:
    """Raise `ValueError` if a parameter is not finite or lies outside its interval."""
    known = parameters(model)
    for name, array in values(model).items():
        value = np.asarray(array)
        # float32 has rounded the bound as well as the value
        lower, upper = value.dtype.type(known[name].lower), known[name].upper
        if not np.all((value >= lower) & (value <= value.dtype.type(upper))):
            shown = ", ".join(f"{v:g}" for v in np.atleast_1d(value))
            raise ValueError(
                f"Parameter `{name}` of `{registry_name(model)}` must lie in "
                f"{known[name]}, but is {shown}."
            )


def registry_name(model: eqx.Module | type[eqx.Module]) -> str:
    """Name of a model everywhere: that of its file; of a sum, those of its parts.

    A sum of `ggx` and `ggx_lobe` is called ``ggx+ggx_lobe``.
    """
    if isinstance(model, type):
        return model.__module__.rpartition(".")[2]
    fields = [getattr(model, field.name) for field in dataclasses.fields(model)]
    parts = [registry_name(part) for part in fields if isinstance(part, eqx.Module)]
    return "+".join(parts) or registry_name(type(model))
