"""The BRDFs for which a plan must hold while parameters are not known."""

import jax.numpy as jnp

from brdffit.models.base import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import parameters, replace, values

RANGES = ("given", "typical", "bounds")


def extremes(
    brdf: AbstractBRDF, within: str, linear: bool = False
) -> list[AbstractBRDF]:
    """The model as it is, or with its parameters all low and all high.

    Args:
        brdf: A model.
        within: ``given`` for its values, ``typical`` or ``bounds`` for the ends of
            those ranges.
        linear: Whether linear parameters count, too; they do not for relative errors.

    Raises:
        ValueError: There is no such range.
    """
    look_up(dict.fromkeys(RANGES), within, "`within`")
    if within == "given":
        return [brdf]
    known, current = parameters(brdf), values(brdf)
    ends = {
        name: p.typical if within == "typical" else (p.lower, p.upper)
        for name, p in known.items()
        if linear or not p.linear
    }
    return [
        replace(
            brdf,
            {
                name: jnp.full_like(current[name], both[side])
                for name, both in ends.items()
            },
        )
        for side in (0, 1)
    ]
