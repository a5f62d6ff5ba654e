"""A BRDF in the words of a renderer, and what every translation needs."""

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models import AbstractBRDF
from brdffit.models.base import RGB
from brdffit.types import Values, Vectors

Evaluate = Callable[[Vectors, Vectors], Values]


@dataclasses.dataclass(frozen=True)
class Material:
    """A translated BRDF.

    Attributes:
        evaluate: ``f_r (N, 3)`` as the target computes it.
        write: Writes the file of the target.
        parameters: What the target is told.
        evaluator: Who evaluates, for people.
        notes: A sentence for each thing that the target does otherwise.
    """

    evaluate: Evaluate
    write: Callable[[Path], None]
    parameters: Mapping[str, Any]
    evaluator: str
    notes: tuple[str, ...] = ()


def in_rgb(brdf: AbstractBRDF, target: str, channels: Sequence[str] = ()) -> Any:
    """The same BRDF with three channels; one channel is taken for grey.

    Args:
        brdf: Any BRDF.
        target: Name of the target, for the error.
        channels: Names of its channels, if they are known.

    Raises:
        ValueError: It has another number of channels, or three that are not R, G, B.
    """
    other = len(channels) == RGB and tuple(channels) != ("R", "G", "B")
    if brdf.channels not in (1, RGB) or other:
        names = ", ".join(channels) or str(brdf.channels)
        raise ValueError(
            f"A material of {target} must be grey or R, G, B, but this one has the "
            f"channels {names}: fit the data in RGB (option --illuminant)."
        )
    if brdf.channels == RGB:
        return brdf
    return jax.tree.map(lambda a: jnp.repeat(a, RGB) if a.ndim else a, brdf)


def evaluator(brdf: Callable[[Any, Any], Any]) -> Evaluate:
    """A BRDF of one pair of directions as a function of many."""
    return lambda wi, wo: np.asarray(
        many(brdf, jnp.asarray(wi, jnp.float32), jnp.asarray(wo, jnp.float32))
    )


@eqx.filter_jit
def many(brdf: Callable[[Any, Any], Any], wi: jax.Array, wo: jax.Array) -> jax.Array:
    """``f_r`` of many pairs of directions."""
    return jax.vmap(brdf)(wi, wo)


def plain(values: Any) -> Any:
    """Numbers as short as their precision allows, in types that any format knows."""
    array = np.asarray(values, np.float32)
    with np.printoptions(legacy=False):
        return array.astype(str).astype(float).tolist()
