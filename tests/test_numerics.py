"""Values that are right, and derivatives that are finite where others' are not."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import numerics

ORDINARY = np.array([0.03, 0.2, 0.7, 0.99], np.float32)


@pytest.mark.parametrize(
    ("function", "textbook"),
    [
        (numerics.sqrt, np.sqrt),
        (numerics.arccos, np.arccos),
        (numerics.log, np.log),
        (numerics.cbrt, np.cbrt),
        (numerics.log_ratio, lambda x: np.log(x) / (x - 1)),
        (numerics.log1p_ratio, lambda x: np.log1p(x) / x),
    ],
)
def test_ordinary_values_are_the_textbook_ones(function, textbook):
    np.testing.assert_allclose(
        function(jnp.asarray(ORDINARY)), textbook(ORDINARY.astype(float)), rtol=1e-6
    )


@pytest.mark.parametrize(
    ("function", "at", "value"),
    [
        (numerics.sqrt, 0.0, 0.0),
        (numerics.sqrt, -1e-7, 0.0),
        (numerics.arccos, 1.0, 0.0),
        (numerics.arccos, 1.0000001, 0.0),
        (numerics.arccos, -1.0, np.pi),
        (numerics.cbrt, 0.0, 0.0),
        (numerics.cbrt, -1.0, 0.0),
        (numerics.log, 0.0, np.log(np.finfo(np.float32).tiny)),
        (numerics.log, -1.0, np.log(np.finfo(np.float32).tiny)),
        (lambda x: numerics.divide(jnp.ones_like(x), x), 0.0, 0.0),
        (lambda x: numerics.arctan2(x, x), 0.0, 0.0),
        (lambda x: numerics.pow(x, jnp.zeros_like(x)), 0.0, 0.0),
        (lambda x: numerics.pow(jnp.zeros_like(x), x), 2.0, 0.0),
        (lambda x: numerics.pow_near_one(1 - x, x, 3 * jnp.ones_like(x)), 1.0, 0.0),
        (lambda x: numerics.pow_near_one(0 * x, jnp.ones_like(x), x), 0.0, 0.0),
        (lambda x: numerics.norm_of(x, x, x), 0.0, 0.0),
        (lambda x: numerics.norm(jnp.stack([x, x, x])), 0.0, 0.0),
        (lambda x: numerics.normalize(jnp.stack([x, x]))[0], 0.0, 0.0),
        (numerics.log_ratio, 1.0, 1.0),
        (numerics.log1p_ratio, 0.0, 1.0),
        (lambda x: numerics.angle_ratio(x, jnp.ones_like(x)), 0.0, 1.0),
    ],
)
def test_value_and_derivatives_are_finite_at_the_singular_point(function, at, value):
    at = jnp.float32(at)
    found, backwards = jax.value_and_grad(function)(at)
    _, forwards = jax.jvp(function, (at,), (jnp.ones_like(at),))
    assert float(found) == pytest.approx(value, rel=1e-6)
    assert np.isfinite(backwards)
    assert float(backwards) == float(forwards)


def test_high_power_of_a_number_near_one_keeps_its_digits():
    """A power of 1 - 1e-6 in float32 is off by 5 %; given the 1e-6 it is not."""
    deficit, exponent = np.float32(1e-6), np.float32(1e5)
    exact = (1 - float(deficit)) ** 1e5
    near = jnp.float32(1 - deficit), jnp.asarray(deficit), jnp.float32(exponent)
    assert float(numerics.pow_near_one(*near)) == pytest.approx(exact, rel=1e-6)
    naive = float(np.float32(1 - deficit) ** exponent)
    assert naive != pytest.approx(exact, rel=1e-3)


def test_power_of_a_small_number_keeps_its_digits():
    """What 1 - 1e-6 leaves of 1 is off by 1 % in float32; given itself it is not."""
    x = jnp.float32(1e-6)
    power = jax.value_and_grad(numerics.pow_near_one)
    value, slope = power(x, 1 - x, jnp.float32(1))
    assert float(value) == pytest.approx(1e-6, rel=1e-5)
    assert float(slope) == pytest.approx(1, rel=1e-5)


def test_power_of_a_number_above_one_does_not_overflow():
    """Off-specular lobes can have a base above 1 and a large exponent."""
    value, slope = jax.value_and_grad(numerics.pow_near_one)(
        jnp.float32(4.0), jnp.float32(-3.0), jnp.float32(1e5)
    )
    assert np.isfinite(value)
    assert np.isfinite(slope)
    assert value > 1e30


@pytest.mark.parametrize("x", [1e-4, 0.5, 0.96, 0.9701, 0.99999, 1.0, 1.0299, 1.1, 3.0])
def test_log_ratio_has_exact_value_and_derivative(x):
    with jax.enable_x64(True):
        value, slope = jax.value_and_grad(numerics.log_ratio)(jnp.float64(x))
    if x == 1:
        expected = (1.0, -0.5)
    else:
        ratio = np.log(x) / (x - 1)
        expected = (ratio, (1 / x - ratio) / (x - 1))
    assert float(value) == pytest.approx(expected[0], rel=1e-13)
    assert float(slope) == pytest.approx(expected[1], rel=1e-9)


def test_angle_ratio_is_the_angle_over_its_sine():
    angle = np.array([1e-4, 0.1, 0.2, 0.21, 1.0, 1.5, np.pi / 2], np.float32)
    sine, cosine = np.sin(angle.astype(float)), np.cos(angle.astype(float))
    found = numerics.angle_ratio(
        jnp.asarray(sine, jnp.float32), jnp.asarray(cosine, jnp.float32)
    )
    np.testing.assert_allclose(found, angle / sine, rtol=1e-6)


def test_normalize_gives_unit_vectors():
    v = jnp.array([3e-5, -4e-5, 12e-5])
    assert jnp.allclose(numerics.normalize(v), v / 13e-5, rtol=1e-6)
