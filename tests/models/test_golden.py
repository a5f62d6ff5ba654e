"""Every model and every part against values worked out with 110 digits.

The file of golden cases is not part of the repository; its own `meta` says how it was
made and how close a result must be. Directions there are normalised exactly before they
are used, and so they are here.
"""

from typing import NamedTuple

import jax
import numpy as np
import pytest

from brdffit import numerics
from tests.models.golden import (
    DIRECTIONS,
    ENTRIES,
    WITHOUT_COUNTERPART,
    cases_of,
    golden,
)

FLOOR = 1e-35  # below it float32 has no digits left to compare


class Tolerance(NamedTuple):
    """How close a result must be; the file's `meta` gives the figures for float32."""

    name: str
    value: float
    derivative: float
    additive: float
    rounding: float  # of inputs, in units of the 1e-7 that sensitivities are given for


SINGLE = Tolerance("f32", 2e-5, 1e-4, 1e-6, 1.0)
DOUBLE = Tolerance("f64", 1e-12, 1e-11, 1e-13, 2e-9)


def test_every_entry_of_the_file_has_a_counterpart_or_none_by_intent():
    assert set(golden()) == set(ENTRIES) | WITHOUT_COUNTERPART


@pytest.mark.parametrize("name", ENTRIES)
@pytest.mark.parametrize("tolerance", [SINGLE, DOUBLE], ids=["single", "double"])
def test_values_and_derivatives_agree_with_golden_cases(name, tolerance):
    dtype = np.float32 if tolerance is SINGLE else np.float64
    cases = cases_of(name)
    with jax.enable_x64(tolerance is DOUBLE):
        found = evaluate(name, cases, dtype)
    wrong = []
    for i, case in enumerate(cases):
        ours = {what: numbers[i] for what, numbers in found.items()}
        wrong += disagreements(case, ours, ENTRIES[name].scale(case), tolerance)
    assert cases
    assert not wrong, "\n".join(wrong)


def evaluate(name, cases, dtype):
    """Values, derivatives by parameters, gradients by directions: one compiled call."""
    names = DIRECTIONS[golden()[name]["kind"]]
    parameters = {
        n: np.array([case["params"][n] for case in cases], dtype)
        for n in cases[0]["params"]
    }
    directions = [np.array([case[n] for case in cases], dtype) for n in names]

    def total(p, *directions):
        return ENTRIES[name].evaluate(p, *map(numerics.normalize, directions))

    everything = jax.value_and_grad(total, tuple(range(1 + len(names))))
    value, (by_parameter, *gradients) = jax.jit(jax.vmap(everything))(
        parameters, *directions
    )
    found = {"value": value} | {f"d/d{n}": d for n, d in by_parameter.items()}
    found |= {f"grad {n}": d for n, d in zip(names, gradients, strict=True)}
    return {what: np.asarray(numbers) for what, numbers in found.items()}


def disagreements(case, ours, offset, tolerance):
    """A sentence for each number that is not as close as it must be."""
    skipped = case.get("corner", {}).get(tolerance.name, [])
    if "value" in skipped:
        return []
    wrong = []
    for what, true, bound in expectations(case, offset, tolerance):
        found = ours[what]
        overflow = np.abs(true) > np.finfo(found.dtype).max
        good = np.isnan(true) | (np.abs(found - true) <= bound)
        good = np.where(overflow, ~np.isnan(found), np.isfinite(found) & good)
        if what not in skipped and not np.all(good):
            wrong.append(
                f"{case['id']} {what}: {found}, not {true}, within {bound:.2g}"
            )
    return wrong


def expectations(case, offset, tolerance):
    """Name, truth and allowed error of each number; NaN where there is no truth."""
    truth, sensitivity = case["value"], case.get("sens", {})

    def allowed(size, relative, name, scale):
        shaken = 20 * tolerance.rounding * sensitivity.get(name, 0.0)
        moved = tolerance.value * abs(truth) * (name != "value")
        additive = tolerance.additive * offset + moved
        return abs(size) * (relative + shaken) + additive * scale + FLOOR

    yield "value", truth, allowed(truth, tolerance.value, "value", 1.0)
    for name, d in case["d"].items():
        true = d["v"] if d["s"] == "ok" else np.nan
        scale = 1 / (abs(case["params"][name]) or 1.0)
        yield f"d/d{name}", true, allowed(true, tolerance.derivative, name, scale)
    for name, gradient in case.get("grad", {}).items():
        true = np.array([np.nan if g is None else g for g in gradient], float)
        if "near_kink" in case["tags"]:
            true = true * np.nan  # the gradient of either side is right
        length = np.sqrt(np.nansum(true * true))
        bound = allowed(length, tolerance.derivative, f"grad_{name}", 1.0)
        yield f"grad {name}", true, bound + FLOOR * (case["cond"] or 0.0)
