import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.microfacet import multiple_scattering
from brdffit.microfacet.multiple_scattering import (
    average_missing_albedo,
    missing,
    missing_albedo,
)

# 1 - E(mu) for alpha, as worked out with many digits
FACTS = [
    (0.5, 0.3, 1 - 0.8217109949729628),
    (0.9, 1.0, 1 - 0.3275070436194344),
    (0.1, 0.01, 1 - 0.9941239532279088),
    (1e-4, 1e-4, 1 - 0.892075482653786),
    (1.7453292e-6, 0.05, 1 - 0.9999916550457550),
]


def grid(count=300):
    """Cosines and roughnesses, crowded where either is small."""
    rng = np.random.default_rng(0)
    alpha = 10 ** rng.uniform(-4, 0, count)
    mu = alpha * np.sinh(rng.uniform(0, 1, count) * np.arcsinh(1 / alpha))
    return np.minimum(mu, 1 - 1e-9), alpha


def test_all_but_log_two_is_lost_along_the_normal_of_the_roughest_surface():
    """An integral with a closed form: the ndf is constant there."""
    found = missing(np.array([1 - 1e-12]), np.ones(1))
    assert np.isclose(found, np.log(2), rtol=1e-11)
    single = missing_albedo(jnp.asarray(1.0), jnp.asarray(1.0))
    assert np.isclose(single, np.log(2), rtol=1e-5)


@pytest.mark.parametrize(("mu", "alpha", "expected"), FACTS)
def test_what_is_missing(mu, alpha, expected):
    found = missing_albedo(jnp.asarray(mu), jnp.asarray(alpha))
    assert np.isclose(found, expected, rtol=2e-5, atol=2e-9)


@pytest.mark.parametrize(("double", "error"), [(False, 1e-5), (True, 1e-11)])
def test_the_series_gives_the_integral(double, error):
    mu, alpha = grid()
    with jax.enable_x64(double):
        given = jnp.asarray(mu, float), jnp.asarray(alpha, float)
        found = np.asarray(jax.jit(jax.vmap(missing_albedo))(*given))
        exact = missing(*(np.asarray(x, np.float64) for x in given))
    assert np.max(np.abs(found / exact - 1)) < error


def test_the_integral_has_converged(monkeypatch):
    mu, alpha = grid()
    exact = missing(mu, alpha)
    rule = np.polynomial.legendre.leggauss
    monkeypatch.setattr(np.polynomial.legendre, "leggauss", lambda n: rule(2 * n))
    assert np.max(np.abs(exact / missing(mu, alpha) - 1)) < 1e-11


def test_the_average_is_that_over_all_directions():
    node, weight = np.polynomial.legendre.leggauss(200)
    mu = (1 + node) / 2
    for alpha in (0.02, 0.3, 1.0):
        expected = np.sum(weight * mu * missing(mu, np.full_like(mu, alpha)))
        found = average_missing_albedo(jnp.asarray(alpha))
        assert np.isclose(found, expected, rtol=1e-4)


def test_derivatives_are_those_of_the_integral():
    step = 1e-5
    with jax.enable_x64(True):
        slope = jax.grad(missing_albedo, argnums=(0, 1))
        for mu, alpha in ((0.7, 0.4), (0.02, 0.1), (1e-5, 0.01)):
            found = slope(jnp.asarray(mu), jnp.asarray(alpha))
            sides = np.array([1 + step, 1 - step])
            by_mu = missing(mu * sides, np.full(2, alpha))
            by_alpha = missing(np.full(2, mu), alpha * sides)
            expected = [(up - down) / (2 * step) for up, down in (by_mu, by_alpha)]
            assert np.allclose(found, np.array(expected) / [mu, alpha], rtol=1e-6)


def test_tables_are_made_once():
    first = multiple_scattering.table(np.dtype(np.float32))
    assert multiple_scattering.table(np.dtype(np.float32)) is first
