r"""Losses: how much a large residual counts.

A loss replaces the square $u^2$ of a residual in units of its noise by $\rho(u^2)$,
which grows more slowly, so that a few wild values do not lead the fit. The solver sees
it as weights $w = \rho'(u^2)$ on the squares, renewed at each step (A. Beaton and J.
Tukey, Technometrics 16(2), 1974). To add one, write its two functions and its line.
"""

import dataclasses
from collections.abc import Callable
from typing import TypeAlias

import jax.numpy as jnp
from jaxtyping import Array

from brdffit import numerics

Function: TypeAlias = Callable[[Array], Array]

# both lose 5 % of efficiency where the noise is normal after all
HUBER = 1.345
CAUCHY = 2.385


@dataclasses.dataclass(frozen=True)
class Loss:
    """A loss for residuals with outliers.

    Attributes:
        name: Name at the command line.
        rho: What the square ``u**2`` of a residual counts, elementwise.
        weight: Derivative of ``rho``.
    """

    name: str
    rho: Function
    weight: Function


def _huber_rho(square: Array) -> Array:
    far = 2 * HUBER * numerics.sqrt(square) - HUBER**2
    return jnp.where(square <= HUBER**2, square, far)


def _huber_weight(square: Array) -> Array:
    return HUBER / numerics.sqrt(jnp.maximum(square, HUBER**2))


def _cauchy_rho(square: Array) -> Array:
    return CAUCHY**2 * jnp.log1p(square / CAUCHY**2)


def _cauchy_weight(square: Array) -> Array:
    return 1 / (1 + square / CAUCHY**2)


huber = Loss("huber", _huber_rho, _huber_weight)
"""Squares near zero, absolute values beyond (P. Huber, "Robust Estimation of a Location
Parameter", Ann. Math. Statist. 35(1), 1964)."""

cauchy = Loss("cauchy", _cauchy_rho, _cauchy_weight)
"""The logarithm of Cauchy's density: a value far off hardly counts (P. Holland and R.
Welsch, "Robust Regression Using Iteratively Reweighted Least-Squares", Communications
in Statistics A6(9), 1977, which gives the constants of both)."""

LOSSES: dict[str, Loss] = {loss.name: loss for loss in (huber, cauchy)}
