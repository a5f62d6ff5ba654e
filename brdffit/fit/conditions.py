"""What is known of the parameters before a fit: some are held, some have a prior."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TypeAlias

import numpy as np

from brdffit.fit.basis import Problem
from brdffit.fit.residual import Residual
from brdffit.fit.transforms import Layout, bounds, channel_models, to_solver
from brdffit.models import AbstractBRDF
from brdffit.names import look_up

Numbers: TypeAlias = float | Sequence[float] | np.ndarray
Prior: TypeAlias = Sequence[Numbers]  # mean and standard deviation


def held_values(
    layout: Layout, fixed: Mapping[str, Numbers], model: str
) -> dict[int, float]:
    """Values of the fixed parameters of a model, by place.

    Raises:
        ValueError: There is no such parameter, it is given a wrong number of values, or
            one outside its interval.
    """
    held = {}
    for name, given in fixed.items():
        values = _spread(layout, name, given, "held at")
        for place, value in zip(layout.places[name], values, strict=True):
            known = layout.known[place]
            if not known.lower <= value <= known.upper:
                raise ValueError(
                    f"Parameter `{name}` of `{model}` must lie in {known}, but is "
                    f"{value:g}."
                )
            held[place] = float(value)
    return held


def priors_of(
    layout: Layout, priors: Mapping[str, Prior]
) -> tuple[np.ndarray, np.ndarray]:
    """Mean and inverse variance of the prior at every place; 0 and 0 without one.

    Raises:
        ValueError: There is no such parameter, or its prior is not a mean and a
            standard deviation above 0.
    """
    mean, precision = np.zeros((2, len(layout.labels)))
    for name, prior in priors.items():
        look_up(layout.places, name, "Parameter")
        if len(prior) != 2:
            raise ValueError(
                f"The prior of `{name}` must be a mean and a standard deviation, but "
                f"is {prior!r}."
            )
        centre, deviation = (
            _spread(layout, name, part, "given a prior with") for part in prior
        )
        if not np.all(np.isfinite(centre) & (deviation > 0) & np.isfinite(deviation)):
            raise ValueError(
                f"The prior of `{name}` must have a finite mean and a standard "
                f"deviation above 0, but has {prior[0]} and {prior[1]}."
            )
        places = list(layout.places[name])
        mean[places], precision[places] = centre, deviation**-2.0
    return mean, precision


def bounded_problem(
    layout: Layout,
    brdf: AbstractBRDF,
    residual: Residual,
    held: Mapping[int, float],
) -> partial[Problem]:
    """A fit that lacks only its samples; the places ``held`` keep their values."""
    lower, upper = bounds(layout)
    lower[list(held)] = upper[list(held)] = hold_at(layout, held)
    return partial(
        Problem,
        channels=channel_models(brdf),
        lower=lower,
        upper=upper,
        prior_mean=np.zeros(len(lower)),
        prior_weight=np.zeros(len(lower)),
        spread=np.ones(()),
        layout=layout,
        residual=residual,
    )


def hold_at(layout: Layout, held: Mapping[int, float]) -> np.ndarray:
    """Solver coordinates of the held values, in their order."""
    natural = np.array([p.typical[0] for p in layout.known])
    natural[list(held)] = list(held.values())
    return to_solver(layout, natural)[list(held)]


def _spread(layout: Layout, name: str, given: Numbers, verb: str) -> np.ndarray:
    """One number for each place of a parameter."""
    places = look_up(layout.places, name, "Parameter")
    values = np.asarray(given, float).ravel()
    if values.size not in (1, len(places)):
        raise ValueError(
            f"Parameter `{name}` must be {verb} one number"
            f"{f' or {len(places)}' if len(places) > 1 else ''}, but is given "
            f"{values.size}."
        )
    return np.broadcast_to(values, len(places))
