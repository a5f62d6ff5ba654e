"""The solution looked at: errors, bounds, costs under every residual, in words."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.compiled import compiled
from brdffit.fit import structure
from brdffit.fit.basis import Problem
from brdffit.fit.costs import costs
from brdffit.fit.residual import RESIDUALS
from brdffit.fit.robust import inflation
from brdffit.fit.search import Search
from brdffit.fit.status import CONVERGED, sentence
from brdffit.fit.transforms import Layout, to_natural
from brdffit.fit.uncertainty import uncertainty

AT_BOUND = 1e-7  # distance from a bound, in widths of the interval
POOR = 0.5  # share of the variation of the data below which a model explains little
NEARBY = 0.02  # distance from a bound within which to try whether it serves as well


def examine(
    problem: Problem,
    found: Search,
    held: Mapping[int, float],
    count: int,
    known_sigma: bool,
) -> dict[str, Any]:
    """Facts about a solution, by the names of `FitResult`.

    Args:
        problem: The fit, with its samples in double precision.
        found: The solution.
        held: Values of the parameters that were fixed, by place.
        count: Number of values used.
        known_sigma: True when the weights are inverse variances.
    """
    layout = problem.layout
    lower, upper = np.asarray(problem.lower), np.asarray(problem.upper)
    x, (equations, tallies, natural, slopes) = _settled(problem, found.x)
    lost, robust = 1.0, problem.loss is not None
    if robust:
        lost = float(inflation(problem, jnp.asarray(x)) * problem.spread**2)
        problem = dataclasses.replace(problem, loss=None)
        equations = _look(problem, x)[0]
    expected = np.asarray(problem.prior_weight) * (natural - problem.prior_mean) ** 2
    natural[list(held)] = list(held.values())
    near = AT_BOUND * (upper - lower)
    fixed = np.isin(np.arange(len(x)), list(held))
    low, high = ~fixed & (x <= lower + near), ~fixed & (x >= upper - near)
    cost = float(equations.cost - np.sum(expected) / 2)
    freedom = count - int(np.sum(~fixed & ~low & ~high))
    if robust:
        variance = lost * count / max(freedom, 1)
    else:
        variance = 1.0 if known_sigma else 2 * cost / max(freedom, 1)
    errors = uncertainty(
        hessian=equations.hessian,
        natural=natural,
        slopes=slopes,
        widths=np.where(upper > lower, upper - lower, 1.0),
        fixed=fixed,
        at_bound=low | high,
        variance=variance,
        labels=layout.labels,
    )
    for place in np.flatnonzero((low | high) & (np.diag(equations.hessian) == 0)):
        if (error := _error_of_a_square(problem, x, place, equations, variance)) >= 0:
            errors.undetermined.pop(layout.labels[place], None)
            errors.standard_errors[place] = error * abs(slopes[place])
    at_bound = {
        layout.labels[i]: f"`{layout.labels[i]}` is at its {side} bound "
        f"{getattr(layout.known[i], side):g}."
        for side, where in (("lower", low), ("upper", high))
        for i in np.flatnonzero(where)
        if layout.labels[i] not in errors.undetermined
    }
    explained = _explained(problem, cost)
    unknowns = len(x) - len(held) + (not known_sigma)
    deviance = _deviance(cost, count, known_sigma)
    return {
        "parameters": _by_name(layout, natural),
        "standard_errors": _by_name(layout, errors.standard_errors),
        "labels": layout.labels,
        "correlation": errors.correlation,
        "at_bound": at_bound,
        "undetermined": errors.undetermined,
        "cost": cost,
        "costs": {n: float(t[0]) for n, t in zip(RESIDUALS, tallies, strict=True)},
        "rms": {
            n: math.sqrt(t[1] / t[2]) if t[2] > 0 else math.nan
            for n, t in zip(RESIDUALS, tallies, strict=True)
        },
        "count": count,
        "chi_square": 2 * cost if known_sigma else None,
        "p_value": _p_value(2 * cost, freedom) if known_sigma else None,
        "aicc": deviance
        + 2 * unknowns
        + 2 * unknowns * (unknowns + 1) / max(count - unknowns - 1, 1),
        "bic": deviance + unknowns * math.log(count),
        "converged": found.status == CONVERGED,
        "held": tuple(layout.labels[place] for place in sorted(held)),
        "explained": explained,
        "status": _sentence(found, explained),
        "steps": found.steps,
        "basins": found.basins,
        "agreement": found.agreement,
    }


def _settled(problem: Problem, x: np.ndarray):
    """The solution, moved onto each nearby bound that costs nothing.

    Where a parameter enters as a square, the slope of the cost vanishes at its bound 0
    and a solver only creeps there. Returns the point and what `_at` says of it.
    """
    facts = _look(problem, x)
    bounds = np.asarray(problem.lower), np.asarray(problem.upper)
    for place in range(len(x)):
        for bound in bounds:
            distance = abs(x[place] - bound[place])
            if 0 < distance < NEARBY * (bounds[1] - bounds[0])[place]:
                moved = x.copy()
                moved[place] = bound[place]
                there = _look(problem, moved)
                if there[0].cost <= facts[0].cost + facts[0].rounding:
                    x, facts = moved, there
    return x, facts


def _look(problem: Problem, x: np.ndarray):
    """What `_at` says of a point, as arrays that can be changed."""
    return jax.tree.map(np.array, _at(problem, x))


def _error_of_a_square(problem, x, place, equations, variance) -> float:
    """Standard error of a parameter on a bound where the slope of the model vanishes.

    The model is even about the bound, so the cost rises with the fourth power; how fast
    is read off a step away. Negative when it does not rise: then nothing depends on it.
    """
    lower, upper = problem.lower[place], problem.upper[place]
    step = NEARBY * float(upper - lower)
    away = x.copy()
    away[place] += step if x[place] <= lower else -step
    rise = float(_at(problem, away)[0].cost - equations.cost)
    if rise <= equations.rounding:
        return -1.0
    return step * (variance / 2 / rise) ** 0.25


@compiled
def _at(problem: Problem, x):
    """Normal equations, costs, values and their slopes at one point."""
    places = tuple(range(x.shape[0]))

    def natural(x):
        return to_natural(problem.layout, x, places)

    values, slopes = jax.jvp(natural, (x,), (jnp.ones_like(x),))
    residuals = tuple(RESIDUALS.values())
    equations = structure.stream(problem, x)
    return equations, costs(problem, x, residuals), values, slopes


def _by_name(layout: Layout, vector: np.ndarray) -> dict[str, Any]:
    """A float for each shared parameter, an array for each spectral one."""
    return {
        name: vector[list(layout.places[name])]
        if known.spectral
        else float(vector[layout.places[name][0]])
        for name, known in layout.entries
    }


def _deviance(cost: float, count: int, known_sigma: bool) -> float:
    """Minus twice the log-likelihood of Gaussian errors, up to a constant."""
    if known_sigma:
        return 2 * cost
    return count * math.log(max(2 * cost / count, np.finfo(float).tiny))


def _p_value(chi_square: float, freedom: int) -> float:
    from scipy.special import gammaincc

    return float(gammaincc(max(freedom, 1) / 2, chi_square / 2))


def _explained(problem: Problem, cost: float) -> float | None:
    """Share of the weighted variance of the data that the model explains."""
    block = problem.blocks
    weight = np.broadcast_to(np.square(block.scale), block.target.shape)
    whole = np.sum(weight, axis=(0, 2), keepdims=True)
    mean = np.sum(weight * block.target, axis=(0, 2), keepdims=True) / whole
    variation = float(np.sum(weight * np.square(block.target - mean)))
    rounding = np.finfo(np.float32).eps * float(np.sum(whole * mean**2))
    return 1 - 2 * cost / variation if variation > rounding else None


def _sentence(found: Search, explained: float | None) -> str:
    doubt = ""
    if explained is None:
        doubt = " The data do not vary, so they say little about the material."
    elif explained < POOR:
        doubt = (
            f" The model explains {max(explained, 0):.0%} of the variation of the "
            "data: another may be called for."
        )
    return (
        f"{sentence(found.status, found.steps)}; "
        f"{found.agreement:.0%} of the starts agree on this minimum"
        f"{f' of {found.basins} met' if found.basins > 1 else ''}.{doubt}"
    )
