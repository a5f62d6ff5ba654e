"""Models by name and in numbers: ``ggx``, ``ggx+ggx_lobe``, or a table of values."""

import dataclasses
import functools
import operator
from collections.abc import Mapping
from typing import Any

import jax
import numpy as np

from brdffit.models import MODELS, AbstractBRDF
from brdffit.models.base import RGB
from brdffit.names import look_up
from brdffit.parameters import broadcast, registry_name
from brdffit.per_channel import PerChannel


def from_name(name: str, channels: int = RGB) -> AbstractBRDF:
    """A model with its default values, or a sum of models with ``+`` between them.

    Raises:
        ValueError: There is no such model; the sentence suggests the nearest one.
    """
    parts = [look_up(MODELS, part.strip(), "Model")() for part in name.split("+")]
    brdf = functools.reduce(operator.add, parts)
    return jax.tree.map(
        lambda a: broadcast(np.asarray(a)[:1], (channels,)) if a.ndim else a, brdf
    )


def description(brdf: AbstractBRDF) -> dict[str, Any]:
    """A BRDF in names and numbers, the parts of a sum each by itself.

    Numbers are as short as their precision allows; options are told where they differ
    from their default.
    """
    if isinstance(brdf, PerChannel):
        return {"per_channel": [description(part) for part in brdf.parts]}
    table: dict[str, Any] = {"model": registry_name(type(brdf))}
    for field in dataclasses.fields(brdf):
        value = getattr(brdf, field.name)
        if isinstance(value, AbstractBRDF):
            table[field.name] = description(value)
        elif not field.metadata.get("static"):
            with np.printoptions(legacy=False):
                short = np.asarray(value).astype(str).astype(float).tolist()
            table.setdefault("parameters", {})[field.name] = short
        elif value != field.default:
            table[field.name] = value
    return table


def from_description(table: Mapping[str, Any]) -> AbstractBRDF:
    """The BRDF of which `description` gave this table.

    Raises:
        ValueError: There is no such model, or its values do not fit each other.
        TypeError: The model has no such field.
    """
    fields = dict(table)
    if "per_channel" in fields:
        return PerChannel(tuple(map(from_description, fields["per_channel"])))
    model = look_up(MODELS, fields.pop("model"), "Model")
    fields |= fields.pop("parameters", {})
    parts = {
        name: from_description(value) if isinstance(value, Mapping) else value
        for name, value in fields.items()
    }
    return model(**parts)
