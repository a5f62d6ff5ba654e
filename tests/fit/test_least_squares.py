"""Problems with certified answers: the StRD collection of NIST."""

import re

import jax.numpy as jnp
import numpy as np
import pytest

import brdffit
from tests.data import shared_data

FORMULAS = {
    "Chwirut2": lambda b, x: jnp.exp(-b[0] * x) / (b[1] + b[2] * x),
    "DanWood": lambda b, x: b[0] * x ** b[1],
    "Eckerle4": lambda b, x: b[0] / b[1] * jnp.exp(-0.5 * ((x - b[2]) / b[1]) ** 2),
    "Gauss1": lambda b, x: (
        b[0] * jnp.exp(-b[1] * x)
        + b[2] * jnp.exp(-((x - b[3]) ** 2) / b[4] ** 2)
        + b[5] * jnp.exp(-((x - b[6]) ** 2) / b[7] ** 2)
    ),
    "Hahn1": lambda b, x: (
        (b[0] + b[1] * x + b[2] * x**2 + b[3] * x**3)
        / (1 + b[4] * x + b[5] * x**2 + b[6] * x**3)
    ),
    "Kirby2": lambda b, x: (
        (b[0] + b[1] * x + b[2] * x**2) / (1 + b[3] * x + b[4] * x**2)
    ),
    "Lanczos3": lambda b, x: (
        b[0] * jnp.exp(-b[1] * x)
        + b[2] * jnp.exp(-b[3] * x)
        + b[4] * jnp.exp(-b[5] * x)
    ),
    "MGH17": lambda b, x: b[0] + b[1] * jnp.exp(-x * b[3]) + b[2] * jnp.exp(-x * b[4]),
    "Misra1a": lambda b, x: b[0] * (1 - jnp.exp(-b[1] * x)),
    "Misra1b": lambda b, x: b[0] * (1 - (1 + b[1] * x / 2) ** -2),
    "Rat43": lambda b, x: b[0] / (1 + jnp.exp(b[1] - b[2] * x)) ** (1 / b[3]),
    "Roszman1": lambda b, x: b[0] - b[1] * x - jnp.arctan(b[2] / (x - b[3])) / jnp.pi,
    "Thurber": lambda b, x: (
        (b[0] + b[1] * x + b[2] * x**2 + b[3] * x**3)
        / (1 + b[4] * x + b[5] * x**2 + b[6] * x**3)
    ),
}


def certified(name):
    """Rows start 1, start 2, value, deviation of each parameter; then the data."""
    text = shared_data("nist_strd", f"{name}.dat").read_text()
    rows = re.findall(r"^\s*b\d+ =\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", text, re.MULTILINE)
    data = text.rpartition("Data:")[2].splitlines()[1:]
    y, x = np.array([line.split() for line in data if line.strip()], float).T
    return np.array(rows, float), x, y


def digits(found, truth):
    """Number of digits that agree, by the definition of NIST."""
    with np.errstate(divide="ignore"):
        return np.minimum(-np.log10(np.abs(found - truth) / np.abs(truth)), 11)


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", FORMULAS)
def test_certified_values_are_found_from_both_starts(name, start):
    rows, x, y = certified(name)
    result = brdffit.least_squares(lambda b: FORMULAS[name](b, x) - y, rows[:, start])
    assert result.converged
    assert digits(result.parameters, rows[:, 2]).min() >= 8
    assert digits(result.standard_errors, rows[:, 3]).min() >= 6


def test_a_bound_holds_exactly_and_is_reported():
    def residual(p):
        return jnp.stack([p["a"] - 3.0, p["b"][0] - 1.0, p["b"][1] + 2.0])

    result = brdffit.least_squares(
        residual, {"a": 0.5, "b": np.zeros(2)}, bounds=(-1.0, 1.5), sigma=0.1
    )
    assert result.parameters["a"] == 1.5
    np.testing.assert_allclose(result.parameters["b"], [1.0, -1.0], rtol=1e-12)
    assert set(result.at_bound) == {"a", "b[1]"}
    np.testing.assert_allclose(result.standard_errors["b"][0], 0.1, rtol=1e-9)


def test_a_start_outside_its_bounds_is_refused():
    with pytest.raises(ValueError, match=r"Start `a` must lie in \[0, 1\], but is 3"):
        brdffit.least_squares(lambda p: p["a"][None], {"a": 3.0}, bounds=(0.0, 1.0))


def test_what_the_residual_cannot_tell_is_said():
    x = np.linspace(0, 1, 9)
    result = brdffit.least_squares(
        lambda p: p["a"] * p["b"] * x - 6 * x, {"a": 1.0, "b": 1.0}, bounds=(0.0, 10.0)
    )
    assert set(result.undetermined) == {"a", "b"}
    assert float(result.parameters["a"] * result.parameters["b"]) == pytest.approx(6)
