import jax
import jax.numpy as jnp
import mpmath
import numpy as np
import pytest

from brdffit.microfacet.diffraction import (
    effective_roughness,
    lambert_w_of_square,
    scattering_lobe,
    stirling_series,
)
from tests.oracle.wave import series

TIMES = np.array([0.0, 1e-10, 1e-3, 0.3, 0.999, 1.0, 1.5, 10.0, 1e3, 1e6, 1e12])


@pytest.mark.parametrize(("double", "error"), [(False, 2e-7), (True, 1e-15)])
def test_lambert_function_solves_its_equation(double, error):
    with jax.enable_x64(double):
        x = jnp.asarray(TIMES, float)
        found, slope = jax.vmap(jax.value_and_grad(lambert_w_of_square))(x)
        exact = [float(mpmath.lambertw(mpmath.mpf(float(v)) ** 2).real) for v in x]
    exact = np.array(exact)
    assert np.allclose(found, exact, rtol=error, atol=0)
    # d W = W / (1 + W) d log(x^2), and 2 x at 0
    expected = np.divide(2 * exact, TIMES * (1 + exact), out=2 * TIMES, where=TIMES > 0)
    assert np.allclose(slope, expected, rtol=4 * error + 1e-9 * double, atol=1e-12)


@pytest.mark.parametrize(("double", "error"), [(False, 1e-5), (True, 1e-13)])
@pytest.mark.parametrize(
    ("g", "t"),
    [
        (1e-6, 0.5),
        (0.3, 0.0),
        (1.0, 15.0),
        (12.0, 0.25),
        (40.0, 22.0),
        (1500.0, 0.0),
        (1500.0, 1.25),
        (2e5, 0.5),
        (1e-3, 100.0),
    ],
)
def test_lobe_is_the_sum_over_all_orders(g, t, double, error):
    with jax.enable_x64(double):
        found, slopes = jax.value_and_grad(scattering_lobe, argnums=(0, 1))(
            jnp.asarray(g, float), jnp.asarray(t, float)
        )
    with mpmath.workdps(40):
        g, t, step = mpmath.mpf(g), mpmath.mpf(t), mpmath.mpf(10) ** -15

        def lobe(g, t):
            return (1 + g) * series(g, (1 + g) * t)

        exact = lobe(g, t)
        by_g = (lobe(g * (1 + step), t) - lobe(g * (1 - step), t)) / (2 * step * g)
        by_t = (lobe(g, t + step) - lobe(g, t - step)) / (2 * step)
    assert np.isclose(found, float(exact), rtol=error)
    # where the lobe is that of slopes alone, its change with g is small, but exact
    assert np.isclose(slopes[0], float(by_g), rtol=10 * error)
    assert np.isclose(slopes[1], float(by_t), rtol=10 * error)


def test_lobe_is_zero_where_there_is_no_roughness():
    value, slope = jax.value_and_grad(scattering_lobe)(jnp.asarray(0.0), jnp.ones(()))
    assert value < 1e-18
    # the first order alone: g exp(-t)
    assert np.isclose(slope, np.exp(-1), rtol=1e-5)


def test_error_of_stirlings_formula():
    polynomial = np.polynomial.Polynomial(stirling_series(np.dtype(np.float64)))
    for m in (1, 2, 7, 100, 10_000):
        with mpmath.workdps(30):
            exact = mpmath.loggamma(m + 1) - (m + 0.5) * mpmath.log(m) + m
            exact -= mpmath.log(2 * mpmath.pi) / 2
        assert np.isclose(polynomial(2 / m - 1) / m, float(exact), rtol=1e-12)


def test_grazing_light_sees_a_smoother_surface():
    sigma0, tau = jnp.asarray(0.5), jnp.asarray(2.0)
    up = jnp.array([0.0, 0.0, 1.0])
    steep = jnp.array([0.6, 0.0, 0.8])
    flat = jnp.array([1.0, 0.0, 1e-4])
    assert effective_roughness(up, up, sigma0, tau) == sigma0
    seen = [effective_roughness(w, w, sigma0, tau) for w in (steep, flat)]
    assert sigma0 >= seen[0] > 2 * seen[1] > 0
