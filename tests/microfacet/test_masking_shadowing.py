"""Projected areas against their definition; the forms of Smith against each other."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.geometry import direction
from brdffit.microfacet import masking_shadowing as masking, ndf
from tests.microfacet.slopes import integrate

SURFACES = {
    "ggx": (ndf.ggx, masking.area_ggx, ()),
    "beckmann": (ndf.beckmann, masking.area_beckmann, ()),
    "student_t heavy": (ndf.student_t, masking.area_student_t, (1.7,)),
    "student_t": (ndf.student_t, masking.area_student_t, (3.0,)),
    "student_t compact": (ndf.student_t, masking.area_student_t, (40.0,)),
}
every_surface = pytest.mark.parametrize(
    ("facets", "area", "shape"), SURFACES.values(), ids=SURFACES
)
ANGLES = [0.0, 0.6, 1.4, 1.57]


def seen(theta, phi, dtype=jnp.float32):
    return direction(jnp.asarray(theta, dtype), jnp.asarray(phi, dtype))


@every_surface
def test_projected_area_is_that_of_the_facets_that_face_a_direction(
    facets, area, shape
):
    @jax.jit
    @jax.vmap
    def both(theta):
        w = direction(theta, jnp.full_like(theta, 0.5))
        numbers = [jnp.asarray(number, theta.dtype) for number in (0.2, 0.6, *shape)]
        facing = integrate(
            lambda wh: facets(wh, *numbers),
            lambda wh: jnp.maximum(jnp.sum(w * wh), 0.0),
            0.2,
        )
        return facing, area(w, *numbers)

    with jax.enable_x64(True):
        expected, found = both(jnp.asarray(ANGLES))
    # what slopes above 1e9 add is left out of the sum
    np.testing.assert_allclose(found, expected, rtol=2e-4)


@every_surface
def test_derivatives_of_projected_area_are_limits_of_differences(facets, area, shape):
    del facets
    numbers = np.array([0.2, 0.6, *shape])
    steps = 1e-5 * np.eye(len(numbers))

    @jax.jit
    @jax.vmap
    def both(theta):
        def area_at(numbers):
            return area(direction(theta, jnp.full_like(theta, 0.5)), *numbers)

        moved = [jax.vmap(area_at)(numbers + side * steps) for side in (1, -1)]
        return jax.grad(area_at)(jnp.asarray(numbers)), (moved[0] - moved[1]) / 2e-5

    with jax.enable_x64(True):
        slopes, differences = both(jnp.asarray(ANGLES))
    np.testing.assert_allclose(slopes, differences, atol=1e-8)


def test_student_t_with_gamma_two_is_masked_as_ggx():
    for theta in ANGLES:
        w, x, y = seen(theta, 0.3), jnp.float32(0.1), jnp.float32(0.8)
        two = masking.area_student_t(w, x, y, jnp.float32(2.0))
        assert float(two) == pytest.approx(float(masking.area_ggx(w, x, y)), rel=1e-6)


@pytest.mark.parametrize(
    "function", [masking.smith_ggx, masking.smith_beckmann], ids=["ggx", "beckmann"]
)
def test_correlation_of_height_lets_more_facets_be_seen(function):
    alpha = jnp.float32(0.5)
    for theta in (0.3, 1.0, 1.5):
        wi, wo = seen(theta, 0.0), seen(0.8, 2.0)
        correlated = float(function(wi, wo, alpha, alpha, False))
        separable = float(function(wi, wo, alpha, alpha, True))
        unmasked = 0.25 / (np.cos(theta) * np.cos(0.8))
        assert separable <= correlated <= unmasked


def test_smith_is_the_textbook_form():
    alpha, theta_i, theta_o = jnp.float32(0.4), 0.7, 1.1
    wi, wo = seen(theta_i, 0.0), seen(theta_o, 2.0)
    tangents = 0.4 * np.tan([theta_i, theta_o])
    light, viewer = (np.sqrt(1 + tangents**2) - 1) / 2
    unmasked = 0.25 / (np.cos(theta_i) * np.cos(theta_o))
    correlated = float(masking.smith_ggx(wi, wo, alpha, alpha, False))
    assert correlated == pytest.approx(unmasked / (1 + light + viewer), rel=1e-6)
    separable = float(masking.smith_ggx(wi, wo, alpha, alpha, True))
    product = (1 + light) * (1 + viewer)
    assert separable == pytest.approx(unmasked / product, rel=1e-6)


def test_rational_masking_is_off_by_less_than_a_third_of_a_percent():
    alpha = jnp.float32(0.5)
    theta = np.arctan(1 / (0.5 * np.linspace(0.05, 3, 400)))
    w = jax.vmap(direction)(jnp.asarray(theta, jnp.float32), jnp.zeros(400))
    exact, rational = (
        np.asarray(jax.vmap(area, (0, None, None))(w, alpha, alpha))
        for area in (masking.area_beckmann, masking.area_beckmann_rational)
    )
    error = np.abs(exact / rational - 1)
    assert error.max() == pytest.approx(0.00313, abs=2e-5)
    b = 1 / (0.5 * np.tan(theta[error.argmax()]))
    assert b == pytest.approx(1.336, abs=0.02)


def test_v_cavity_is_the_textbook_form():
    rng = np.random.default_rng(5)
    v_cavity = jax.jit(masking.v_cavity)
    for _ in range(20):
        angles = rng.uniform(0, 1.5, 2), rng.uniform(0, 6.28, 2)
        light, viewer = (seen(*pair) for pair in zip(*angles, strict=True))
        wi, wo = np.asarray(light, float), np.asarray(viewer, float)
        wh = (wi + wo) / np.linalg.norm(wi + wo)
        ratio = 2 * wh[2] / (wi @ wh)
        expected = min(1, ratio * wi[2], ratio * wo[2]) / (4 * wi[2] * wo[2])
        assert float(v_cavity(light, viewer)) == pytest.approx(expected, rel=3e-6)


def test_all_are_finite_when_both_directions_graze():
    wi = jnp.array([1.0, 0.0, 1e-6])
    alpha, gamma = jnp.float32(1e-4), jnp.float32(1.6)
    for wo in (wi, wi * jnp.array([-1.0, 1.0, 1.0]), jnp.array([0.0, 1.0, 1e-6])):
        for separable in (False, True):
            assert np.isfinite(masking.smith_ggx(wi, wo, alpha, alpha, separable))
            assert np.isfinite(masking.smith_beckmann(wi, wo, alpha, alpha, separable))
            heavy = masking.smith_student_t(wi, wo, alpha, alpha, gamma, separable)
            assert np.isfinite(heavy)
        assert np.isfinite(masking.v_cavity(wi, wo))
