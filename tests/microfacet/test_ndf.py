"""Each ndf: normalised, of any length of its argument, and with the right limits."""

import functools

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.geometry import direction
from brdffit.microfacet import ndf
from tests.microfacet.slopes import integrate

NDFS = {
    "beckmann": (ndf.beckmann, (0.3, 0.3)),
    "beckmann stretched": (ndf.beckmann, (0.05, 0.6)),
    "beckmann smooth": (ndf.beckmann, (1e-4, 1e-4)),
    "ggx": (ndf.ggx, (0.3, 0.3)),
    "ggx stretched": (ndf.ggx, (0.05, 0.6)),
    "ggx smooth": (ndf.ggx, (1e-4, 1e-4)),
    "ggx rough": (ndf.ggx, (1.0, 1.0)),
    "gtr1": (ndf.gtr1, (0.1, 0.1)),
    "gtr1 stretched": (ndf.gtr1, (0.05, 0.6)),
    "gtr1 smooth": (ndf.gtr1, (1e-4, 1e-4)),
    "gtr1 almost rough": (ndf.gtr1, (0.999, 0.999)),
    "gtr1 rough": (ndf.gtr1, (1.0, 1.0)),
    "blinn": (ndf.blinn, (0.2, 0.2)),
    "blinn stretched": (ndf.blinn, (0.05, 0.6)),
    "blinn flat": (ndf.blinn, (1.0, 1.0)),
    "blinn narrow": (ndf.blinn, (1e-4, 1e-4)),
    "student_t": (ndf.student_t, (0.3, 0.3, 3.0)),
    "student_t stretched": (ndf.student_t, (0.1, 0.5, 1.6)),
    "student_t compact": (ndf.student_t, (0.3, 0.3, 40.0)),
}


@functools.cache
def covered(function):
    """Integral of D cos over the hemisphere, from the shape of D."""
    return jax.jit(
        lambda shape: integrate(lambda wh: function(wh, *shape), lambda wh: wh[2], 1e-4)
    )


@pytest.mark.parametrize(("function", "shape"), NDFS.values(), ids=NDFS)
def test_facets_together_cover_the_surface_once(function, shape):
    with jax.enable_x64(True):
        area = float(covered(function)([jnp.float64(number) for number in shape]))
    assert area == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize(("function", "shape"), NDFS.values(), ids=NDFS)
def test_length_of_the_bisector_does_not_matter(function, shape):
    wh = direction(jnp.float32(0.2), jnp.float32(0.7))
    numbers = [jnp.float32(number) for number in shape]
    short, long = (function(scale * wh, *numbers) for scale in (1e-3, 2.0))
    np.testing.assert_allclose(short, long, rtol=2e-4)


def slanted(count=20):
    theta = jnp.linspace(0.0, 1.5, count)
    return jax.vmap(direction)(theta, 2 * theta)


def test_student_t_with_gamma_two_is_ggx():
    wh, x, y = slanted(), jnp.float32(0.2), jnp.float32(0.5)
    two = jax.vmap(ndf.student_t, (0, None, None, None))(wh, x, y, jnp.float32(2.0))
    np.testing.assert_allclose(two, jax.vmap(ndf.ggx, (0, None, None))(wh, x, y), 2e-6)


def test_student_t_approaches_beckmann():
    wh, alpha = slanted(8)[:4], jnp.float32(0.5)
    limit = jax.vmap(ndf.beckmann, (0, None, None))(wh, alpha, alpha)
    far, near = (
        jax.vmap(ndf.student_t, (0, None, None, None))(wh, alpha, alpha, gamma)
        for gamma in (jnp.float32(20.0), jnp.float32(2000.0))
    )
    assert np.max(np.abs(near / limit - 1)) < 1e-2
    assert np.max(np.abs(far / limit - 1)) > 5 * np.max(np.abs(near / limit - 1))


def test_gtr1_is_uniform_when_rough_and_continuous_there():
    wh = slanted(6)
    rough, almost = (
        jax.vmap(ndf.gtr1, (0, None, None))(wh, alpha, alpha)
        for alpha in (jnp.float32(1.0), jnp.float32(0.9999))
    )
    np.testing.assert_allclose(rough, 1 / np.pi, rtol=1e-6)
    np.testing.assert_allclose(almost, rough, rtol=2e-4)


def test_blinn_with_equal_alphas_is_a_power_of_the_cosine():
    wh, exponent = slanted(10), 48.0
    alpha = jnp.float32(np.sqrt(2 / (exponent + 2)))
    found = jax.vmap(ndf.blinn, (0, None, None))(wh, alpha, alpha)
    power = np.asarray(wh, float)[:, 2] ** exponent
    expected = (exponent + 2) / (2 * np.pi) * power
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-30)


@pytest.mark.parametrize(
    "function",
    [
        ndf.beckmann,
        ndf.ggx,
        ndf.gtr1,
        ndf.blinn,
        functools.partial(ndf.student_t, gamma=jnp.float32(3.0)),
    ],
    ids=["beckmann", "ggx", "gtr1", "blinn", "student_t"],
)
def test_stretched_facets_are_wider_along_the_larger_alpha(function):
    """As if turned by a right angle when the alphas change places."""
    narrow, wide = jnp.float32(0.1), jnp.float32(0.5)
    along, across = jnp.array([0.3, 0.0, 0.954]), jnp.array([0.0, 0.3, 0.954])
    assert function(across, narrow, wide) > 3 * function(along, narrow, wide)
    np.testing.assert_allclose(
        function(across, narrow, wide), function(along, wide, narrow), rtol=1e-6
    )


def test_slope_gaussian_is_beckmann_without_its_norm():
    wh, x, y = slanted(10), jnp.float32(0.4), jnp.float32(0.7)
    beckmann = jax.vmap(ndf.beckmann, (0, None, None))(wh, x, y)
    norm = np.pi * 0.4 * 0.7 * np.asarray(wh)[:, 2] ** 4
    gaussian = jax.vmap(ndf.slope_gaussian, (0, None, None))(wh, x, y)
    np.testing.assert_allclose(gaussian, beckmann * norm, rtol=1e-4, atol=1e-30)


def test_ggx_keeps_its_digits_where_the_textbook_form_has_none():
    """With alpha = 2e-4 the usual 1 + (alpha^2 - 1) cos^2 is rounding noise."""
    slope = 2.7e-4
    wh = jnp.array([slope, 0.0, 1.0]) / np.sqrt(1 + slope**2)
    exact = 1 / (np.pi * 4e-8 * ((slope / 2e-4) ** 2 + 1) ** 2) * (1 + slope**2) ** 2
    alpha = jnp.float32(2e-4)
    assert float(ndf.ggx(wh, alpha, alpha)) == pytest.approx(exact, rel=1e-5)
    cosine2 = np.float32(wh[2]) ** 2
    textbook = 4e-8 / (np.pi * float(1 + np.float32(4e-8 - 1) * cosine2) ** 2)
    assert textbook != pytest.approx(exact, rel=1e-2)
