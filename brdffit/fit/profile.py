"""The lowest cost for each value of one parameter: its error without a parabola."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from brdffit.catalogue import from_name
from brdffit.fit.fit import fit
from brdffit.fit.result import FitResult
from brdffit.models import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import parameters
from brdffit.samples import Measurement, Samples

REACH = 4.0  # standard errors to either side that a profile covers
CHI_SQUARE_95 = 3.841458820694124  # 95 % quantile for one degree of freedom


@dataclasses.dataclass(frozen=True)
class Profile:
    """The profile of one parameter, all others refitted at each value.

    Attributes:
        name: The parameter.
        values: Values at which it was held, ascending.
        rise: Twice the rise of the cost above its minimum, in units of the variance of
            the noise: 1 at one standard error if the cost is a parabola.
        interval: Where ``rise`` stays below the 95 % quantile of chi-square; infinite
            on a side where it does not reach that within ``values``.
        result: The fit with the parameter free.
    """

    name: str
    values: np.ndarray
    rise: np.ndarray
    interval: tuple[float, float]
    result: FitResult

    def to_dict(self) -> dict[str, Any]:
        """The profile in types that JSON knows, without the fit."""
        return {
            "name": self.name,
            "values": self.values.tolist(),
            "rise": self.rise.tolist(),
            "interval": [e if np.isfinite(e) else str(e) for e in self.interval],
        }


def profile(
    model: str | AbstractBRDF,
    data: Measurement | Samples,
    name: str,
    *,
    points: int = 15,
    values: Sequence[float] | None = None,
    **options: Any,
) -> Profile:
    """Profile likelihood of a parameter that all channels share.

    Args:
        model: As for `fit`.
        data: As for `fit`.
        name: The parameter.
        points: Number of values, spread over four standard errors to either side.
        values: Values to hold it at, instead of these.
        options: Further options of `fit`.

    Source:
        D. Bates and D. Watts, "Nonlinear Regression Analysis and Its Applications",
        1988, chapter 6.

    Raises:
        ValueError: As for `fit`; or the parameter does not exist, has a value in each
            channel, is held, or has no error that could tell which values to take; or
            there is a loss or a prior.
    """
    if options.get("loss") or options.get("priors"):
        raise ValueError(
            "A profile must be taken without `loss` and `priors`: it shows what the "
            "data alone say."
        )
    result = fit(model, data, **options)
    best = look_up(result.parameters, name, "Parameter")
    if np.ndim(best) or name in result.held:
        raise ValueError(
            f"Parameter `{name}` must be free and have one value in all channels to "
            "have a profile; tie it, or pick a channel."
        )
    if values is not None:
        grid = np.sort(np.asarray(values, float))
    else:
        error = result.standard_errors[name]
        if not np.isfinite(error):
            raise ValueError(
                f"Parameter `{name}` must be determined by the data to have a profile, "
                "or `values` must say where to look."
            )
        reach = REACH * error * np.linspace(-1, 1, points)
        known = parameters(from_name(result.model))[name]
        grid = np.unique(np.clip(best + reach, known.lower, known.upper))
    fixed = dict(options.pop("fixed", None) or {})
    cost = np.array(
        [fit(model, data, fixed=fixed | {name: v}, **options).cost for v in grid]
    )
    variance = 1.0
    if result.chi_square is None:
        variance = 2 * result.cost / max(result.count - len(result.labels), 1)
    rise = 2 * (cost - min(result.cost, cost.min())) / variance
    return Profile(name, grid, rise, _interval(grid, rise, float(best)), result)


def _interval(values: np.ndarray, rise: np.ndarray, best: float) -> tuple[float, float]:
    """Where the rise, between its points a line in its root, crosses the quantile."""
    root = np.sqrt(np.maximum(rise, 0))
    ends = []
    for side, infinite in ((values <= best, -np.inf), (values >= best, np.inf)):
        order = np.argsort(np.abs(values[side] - best))
        at = np.concatenate([[best], values[side][order]])
        height = np.concatenate([[0.0], root[side][order]])
        over = np.flatnonzero(height > np.sqrt(CHI_SQUARE_95))
        if not len(over):
            ends.append(infinite)
            continue
        last = over[0]
        share = (np.sqrt(CHI_SQUARE_95) - height[last - 1]) / (
            height[last] - height[last - 1]
        )
        ends.append(float(at[last - 1] + share * (at[last] - at[last - 1])))
    return ends[0], ends[1]
