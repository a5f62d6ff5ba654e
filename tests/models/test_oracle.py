"""Values and derivatives against the oracle: everyday and hard pairs of every model.

A number may differ from the oracle by rounding, and by what rounding of the input
directions does to it; the second is looked at only where the first does not suffice.
"""

import functools

import jax
import jax.numpy as jnp
import mpmath
import numpy as np
import pytest

from brdffit.models import MODELS
from brdffit.parameters import replace, spectral_fields
from tests.models.test_catalogue import CATALOGUE
from tests.oracle import ORACLE
from tests.oracle.cases import cases
from tests.oracle.derivatives import reflectance, truth
from tests.oracle.record import SLOW, recorded

every_model = pytest.mark.parametrize("name", sorted(ORACLE))

# relative error of value and derivative, and of a direction (for the sensitivity)
SINGLE = (2e-5, 2e-4, 1e-7)
DOUBLE = (1e-12, 1e-10, 2e-16)
# masking is an integral there, taken by a rule of stated error
COARSE = {"student_t": (5e-8, 1e-5, 2e-16)}
# light of several reflections is smooth: what is sensitive is the lobe of the first
SENSITIVE = {"ggx_multiscatter": "ggx"}


def test_oracle_knows_the_whole_catalogue_but_the_sum():
    assert set(CATALOGUE) - {"sum"} <= set(ORACLE) <= set(MODELS)


@pytest.mark.parametrize("name", SLOW)
def test_what_is_recorded_is_what_the_oracle_says(name):
    (chosen, wi, wo), *_ = cases(name)
    with mpmath.workdps(25):
        parameters = {n: mpmath.mpf(float(x)) for n, x in chosen.items()}
        again = reflectance(ORACLE[name], parameters, *map(mpmath.matrix, (wi, wo)))
    assert np.isclose(float(again), recorded(name)[0].value, rtol=1e-14)


@every_model
@pytest.mark.parametrize("double", [False, True], ids=["single", "double"])
def test_value_and_derivatives_agree_with_the_oracle(name, double):
    with jax.enable_x64(double):
        found = evaluate(name, cases(name), jnp.float64 if double else jnp.float32)
    wrong = []
    for case, exact, ours in zip(cases(name), truths(name), found, strict=True):
        tolerance = COARSE.get(name, DOUBLE) if double else SINGLE
        wrong += check(name, case, exact, ours, tolerance)
    assert not wrong, "\n".join(wrong[:10])


def evaluate(name, pairs, dtype):
    """Value and derivatives by the package: one compiled function for all pairs."""
    spectral = spectral_fields(MODELS[name])
    brdf = MODELS[name](**{n: [0.5] for n, many in spectral.items() if many})

    def value(chosen, wi, wo):
        shaped = {n: jnp.reshape(x, (1,) * spectral[n]) for n, x in chosen.items()}
        return replace(brdf, shaped)(wi, wo)[0]

    chosen = {n: np.array([p[n] for p, _, _ in pairs], dtype) for n in pairs[0][0]}
    wi, wo = (np.array([pair[n] for pair in pairs], np.float64) for n in (1, 2))
    lengths = [np.linalg.norm(w, axis=1, keepdims=True) for w in (wi, wo)]
    if dtype == jnp.float64:
        wi, wo = wi / lengths[0], wo / lengths[1]
    every = jax.jit(jax.vmap(jax.value_and_grad(value, argnums=(0, 1, 2))))
    values, (by, to_wi, to_wo) = every(chosen, wi.astype(dtype), wo.astype(dtype))
    return [
        (
            float(values[n]),
            {name: float(d[n]) for name, d in by.items()},
            tangential(to_wi[n], wi[n]) / lengths[0][n],
            tangential(to_wo[n], wo[n]) / lengths[1][n],
        )
        for n in range(len(pairs))
    ]


def tangential(gradient, w):
    """What is left of a gradient by ``w`` when the length of ``w`` does not matter."""
    gradient = np.asarray(gradient, np.float64)
    return gradient - w * (gradient @ w) / (w @ w)


@functools.cache
def truths(name):
    if name in SLOW:
        return recorded(name)
    return [truth(ORACLE[name], *case) for case in cases(name)]


def check(name, case, exact, ours, tolerance):
    """Sentences about each number that is off by more than rounding explains."""
    chosen, wi, wo = case
    wrong = compare(chosen, ours, exact, tolerance, shaken=[])
    if wrong:
        model = ORACLE[SENSITIVE.get(name, name)]
        steady = truth(model, *case) if name in SENSITIVE else exact
        shaken = [
            (
                steady,
                truth(
                    model,
                    chosen,
                    wi.astype(float) * (1 + tolerance[2] * np.array(signs)),
                    wo.astype(float) * (1 - tolerance[2] * np.array(signs)),
                ),
            )
            for signs in ((1, -1, 1), (-1, 1, 1), (1, 1, -1), (-1, 1, -1))
        ]
        wrong = compare(chosen, ours, exact, tolerance, shaken)
    where = ", ".join(f"{n}={x:.9g}" for n, x in chosen.items())
    return [f"{name}({where}) at {wi}, {wo}: {text}" for text in wrong]


def compare(chosen, ours, exact, tolerance, shaken):
    value, by, to_wi, to_wo = ours
    background = tolerance[2] * (1 + 10 * abs(exact.value))
    if abs(exact.value) > 1e37:
        return []

    def off(label, found, right, pick, relative, scale=0.0):
        moved = [(pick(steady), pick(other)) for steady, other in shaken]
        kink = any(x is None for pair in moved for x in pair)
        if right is None or kink or abs(right) > 1e37:
            return []
        loose = 20 * max((abs(x - y) for x, y in moved), default=0.0)
        allowed = relative * (abs(right) + scale) + loose + background
        good = np.isfinite(found) and abs(found - right) <= allowed
        return [] if good else [f"{label} is {found:.9g}, not {right:.9g}"]

    wrong = off("value", value, exact.value, lambda x: x.value, tolerance[0])
    for name, right in exact.parameters.items():
        scale = 0.1 * exact.value / (chosen[name] or 1)
        wrong += off(
            f"d/d{name}",
            by[name],
            right,
            lambda x, name=name: x.parameters[name],
            tolerance[1],
            abs(scale),
        )
    for label, found in (("wi", to_wi), ("wo", to_wo)):
        rights = getattr(exact, label)
        scale = max(abs(x or 0) for x in rights)
        for axis, right in enumerate(rights):
            wrong += off(
                f"gradient by {label}[{axis}]",
                found[axis],
                right,
                lambda x, label=label, axis=axis: getattr(x, label)[axis],
                tolerance[1],
                scale,
            )
    return wrong
