"""Fresnel factors: closed cases, each other, and textbook formulas in float64."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.microfacet import fresnel

COSINES = np.array([1e-3, 0.1, 0.4, 0.8, 1.0])


def textbook(c, n):
    """Reflectance of unpolarised light by complex amplitudes."""
    q = np.sqrt(n * n - 1 + c * c + 0j)
    rs, rp = (c - q) / (c + q), (n * n * c - q) / (n * n * c + q)
    return (abs(rs) ** 2 + abs(rp) ** 2) / 2


@pytest.mark.parametrize("eta", [0.5, 1.2, 1.5, 3.0])
@pytest.mark.parametrize("c", COSINES)
def test_dielectric_is_the_textbook_form(c, eta):
    found = float(fresnel.dielectric(jnp.float32(c), jnp.float32(eta)))
    assert found == pytest.approx(textbook(c, eta), rel=1e-4)


@pytest.mark.parametrize("n", [0.2 + 3.9j, 1.5 + 0.1j, 3.0 + 8.0j, 0.8 + 0.01j])
@pytest.mark.parametrize("c", COSINES)
def test_conductor_is_the_textbook_form(c, n):
    numbers = (jnp.float32(number) for number in (c, n.real, n.imag))
    assert float(fresnel.conductor(*numbers)) == pytest.approx(textbook(c, n), rel=1e-4)


@pytest.mark.parametrize("eta", [0.5, 1.5])
def test_metal_that_does_not_absorb_is_glass(eta):
    c, eta = jnp.asarray(COSINES, jnp.float32), jnp.float32(eta)
    metal = jax.vmap(fresnel.conductor, (0, None, None))(c, eta, jnp.float32(0.0))
    glass = jax.vmap(fresnel.dielectric, (0, None))(c, eta)
    np.testing.assert_allclose(metal, glass, rtol=1e-5)


def test_light_is_reflected_totally_beyond_the_critical_angle():
    critical, eta = np.sqrt(1 - 0.5**2), jnp.float32(0.5)
    assert float(fresnel.dielectric(jnp.float32(critical - 0.01), eta)) == 1
    assert float(fresnel.dielectric(jnp.float32(critical + 0.01), eta)) < 1


def test_weak_interface_keeps_its_digits():
    """With eta = 1 + 1e-6 the reflectance is 2e-13: differences of cosines lose it."""
    eta = np.float32(1 + 1e-6)
    exact = ((float(eta) - 1) / (float(eta) + 1)) ** 2
    found = float(fresnel.dielectric(jnp.float32(1.0), jnp.asarray(eta)))
    assert found == pytest.approx(exact, rel=1e-5)
    slope = float(jax.grad(fresnel.dielectric, 1)(jnp.float32(1.0), jnp.asarray(eta)))
    assert slope == pytest.approx((float(eta) - 1) / 2, rel=1e-5)


def test_no_interface_reflects_nothing():
    for c in (0.0, 1e-6, 0.3, 1.0):
        value, slopes = jax.value_and_grad(fresnel.dielectric, (0, 1))(
            jnp.float32(c), jnp.float32(1.0)
        )
        assert float(value) == 0
        assert all(np.isfinite(slope) for slope in slopes)


@pytest.mark.parametrize(
    ("function", "at"),
    [
        (fresnel.dielectric, [(0.3, 1.5), (0.9, 0.7)]),
        (fresnel.conductor, [(0.3, 0.2, 3.9), (0.9, 3.0, 0.5), (0.1, 0.7, 0.2)]),
        (fresnel.schlick, [(0.3, 0.2)]),
    ],
    ids=["dielectric", "conductor", "schlick"],
)
def test_derivatives_are_limits_of_differences(function, at):
    steps = 1e-6 * np.eye(len(at[0]))

    def of(numbers):
        return function(*numbers)

    @jax.jit
    @jax.vmap
    def both(numbers):
        moved = [
            jax.vmap(of)(numbers[None] + side * jnp.asarray(steps)) for side in (1, -1)
        ]
        return jax.grad(of)(numbers), (moved[0] - moved[1]) / 2e-6

    with jax.enable_x64(True):
        slopes, differences = both(jnp.asarray(at))
    np.testing.assert_allclose(slopes, differences, rtol=1e-6)


def test_each_channel_has_its_own_index():
    c, eta, k = jnp.float32(0.5), jnp.array([0.2, 0.9, 1.5]), jnp.array([3.9, 2.0, 1.9])
    together = fresnel.conductor(c, eta, k)
    alone = [fresnel.conductor(c, eta[i], k[i]) for i in range(3)]
    np.testing.assert_allclose(together, np.array(alone), rtol=1e-6)


def test_schlick_is_exact_at_both_ends_and_never_negative():
    f0 = jnp.array([0.0, 0.04, 1.0])
    np.testing.assert_allclose(fresnel.schlick(jnp.float32(1.0), f0), f0)
    np.testing.assert_allclose(fresnel.schlick(jnp.float32(0.0), f0), np.ones(3))
    # the cosine of a half vector may be rounded to more than 1
    assert np.all(fresnel.schlick(jnp.float32(1.0000001), f0) >= 0)


def test_cosine_of_half_the_angle_between_directions():
    wi, wo = jnp.array([0.6, 0.0, 0.8]), jnp.array([-0.6, 0.0, 0.8])
    assert float(fresnel.cos_d(wi + wo)) == pytest.approx(0.8)
    assert float(fresnel.cos_d(wi + wi)) == pytest.approx(1.0)
