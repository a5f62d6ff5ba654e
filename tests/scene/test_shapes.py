import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.scene import Sphere


def intersect(origin, direction):
    with jax.enable_x64(True):
        arrays = jnp.asarray(origin, float), jnp.asarray(direction, float)
        return tuple(np.asarray(a) for a in Sphere().intersect(*arrays))


def test_a_ray_meets_the_near_side():
    distance, normal = intersect([0.6, 0, 5], [0, 0, -1])
    assert distance == pytest.approx(4.2, rel=1e-15)
    np.testing.assert_allclose(normal, [0.6, 0, 0.8], atol=1e-15)


def test_an_oblique_ray_meets_the_near_side():
    distance, normal = intersect([-3, 0, 0.6], [1, 0, 0])
    assert distance == pytest.approx(2.2, rel=1e-15)
    np.testing.assert_allclose(normal, [-0.8, 0, 0.6], atol=1e-15)


def test_a_far_ray_loses_no_digits():
    _, normal = intersect([0.6, 0, 1e8], [0, 0, -1])
    np.testing.assert_allclose(normal, [0.6, 0, 0.8], atol=1e-15)


@pytest.mark.parametrize(
    ("origin", "direction"),
    [([1.1, 0, 5], [0, 0, -1]), ([1, 0, 5], [0, 0, -1]), ([0, 0, 5], [0, 0, 1])],
    ids=["beside", "touching", "away"],
)
def test_a_ray_beside_touching_or_leaving_misses(origin, direction):
    distance, _ = intersect(origin, direction)
    assert distance == np.inf
