import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.scene import Glass, Mirror


def test_a_mirror_without_k_reflects_all():
    np.testing.assert_array_equal(Mirror().reflected(jnp.array([0.1, 1.0]), 2), 1)


def test_a_metal_reflects_as_fresnel_says():
    mirror = Mirror(eta=[0.2, 1.0], k=[3.0, 2.0])
    cosines = jnp.array([1.0, 1e-6])
    normal, grazing = jax.jit(lambda c: mirror.reflected(c, 2))(cosines)
    expected = [(0.8**2 + 9) / (1.2**2 + 9), 4 / 8]
    np.testing.assert_allclose(normal, expected, rtol=1e-6)
    np.testing.assert_allclose(grazing, 1, atol=1e-4)


def test_glass_reflects_all_beyond_the_critical_angle_from_within_only():
    cosine = jnp.cos(jnp.radians(jnp.array([0.0, 41.0, 42.0, 60.0])))
    reflected = jax.jit(lambda *ray: Glass(1.5).reflected(*ray))
    within, outside = (reflected(cosine, jnp.full(4, x)) for x in (1.0, 0.0))
    np.testing.assert_allclose([within[0], outside[0]], 0.04, rtol=1e-5)
    assert within[1] < 1
    np.testing.assert_array_equal(within[2:], 1)
    assert outside[3] < 0.1


def test_reflectance_is_differentiable_in_the_index():
    @jax.jit
    def total(eta):
        glass = Glass()
        glass = jax.tree.map(lambda _: eta, glass)
        return glass.reflected(jnp.array([0.5]), jnp.zeros(1))[0]

    slope = jax.jit(jax.grad(total))(jnp.asarray(1.5))
    step = (total(jnp.asarray(1.51)) - total(jnp.asarray(1.49))) / 0.02
    assert slope == pytest.approx(float(step), rel=1e-3)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Glass(1.0), "`eta` must not be 1"),
        (lambda: Glass(-1.5), "`eta` must be one number above 0"),
        (lambda: Mirror(eta=0.0, k=1.0), "`eta` must be above 0"),
        (lambda: Mirror(k=[1.0, -1.0]), "`k` must be a number or a list"),
    ],
)
def test_an_index_that_nothing_has_is_refused(make, sentence):
    with pytest.raises(ValueError, match=sentence):
        make()
