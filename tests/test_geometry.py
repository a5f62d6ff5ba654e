"""Directions: each function against its definition."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import geometry
from brdffit.models import Lambert
from tests.sampling import generator, random_directions

NORMAL = jnp.array([0.0, 0.0, 1.0])


@pytest.fixture
def pairs():
    rng = generator(Lambert)
    return random_directions(rng, 50), random_directions(rng, 50)


def each(function):
    return jax.jit(jax.vmap(function))


def test_half_vector_makes_equal_angles_with_both(pairs):
    wh = each(geometry.half_vector)(*pairs)
    np.testing.assert_allclose(np.linalg.norm(wh, axis=1), 1, rtol=1e-6)
    to_light, to_viewer = (np.sum(np.asarray(w) * wh, axis=1) for w in pairs)
    np.testing.assert_allclose(to_light, to_viewer, rtol=1e-5)
    assert np.all(to_light > 0)


def test_bisector_has_the_slopes_of_the_half_vector(pairs):
    wh, bisector = each(geometry.half_vector)(*pairs), each(geometry.bisector)(*pairs)
    np.testing.assert_allclose(np.cross(wh, bisector), np.zeros_like(wh), atol=3e-7)


def test_bisector_at_the_mirror_direction_has_no_slope(pairs):
    wi, _ = pairs
    slopes = each(geometry.bisector)(wi, each(geometry.mirror)(wi))[:, :2]
    assert np.all(slopes == 0)


def test_tangent_does_not_depend_on_length(pairs):
    w, _ = pairs
    expected = (w[:, 0] ** 2 + w[:, 1] ** 2) / w[:, 2] ** 2
    for length in (1.0, 1e-3):
        found = each(geometry.tan_squared)(length * w)
        np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_dot_is_the_sum_of_products(pairs):
    expected = np.sum(np.asarray(pairs[0]) * np.asarray(pairs[1]), axis=1)
    np.testing.assert_allclose(each(geometry.dot)(*pairs), expected, atol=1e-6)


def test_mirror_deficit_is_what_the_cosine_lacks_of_one(pairs):
    wi, wo = pairs
    cosine = np.sum(np.asarray(each(geometry.mirror)(wi), float) * wo, axis=1)
    found = each(geometry.mirror_cosine)(wi, wo)
    np.testing.assert_allclose(found, cosine, atol=3e-7)
    found = each(geometry.mirror_deficit)(wi, wo)
    np.testing.assert_allclose(found, 1 - cosine, atol=3e-7)


def test_mirror_deficit_keeps_its_digits_close_to_the_mirror_direction():
    wi = geometry.direction(jnp.float32(0.5), jnp.float32(0.0))
    wo = geometry.mirror(geometry.direction(jnp.float32(0.5001), jnp.float32(0.0)))
    angle = 0.5001 - 0.5
    found = float(geometry.mirror_deficit(wi, wo))
    # the angle itself is known to 1e-3 only: 1 - cosine would be 0 or 6e-8
    assert found == pytest.approx(angle**2 / 2, rel=3e-3)


def test_larger_cosine_is_told_by_sines_where_cosines_are_equal():
    """Derivatives by both heights: one is 1, or each is a half when all is equal."""
    normal, tilted = jnp.array([0.0, 0.0, 1.0]), jnp.array([1e-4, 0.0, 1.0])
    slanted = jnp.array([0.6, 0.0, 0.8])
    by_height = jax.jit(jax.grad(geometry.larger_cosine, argnums=(0, 1)))
    for pair, expected in [
        ((normal, tilted), (1, 0)),
        ((tilted, normal), (0, 1)),
        ((tilted, tilted), (0.5, 0.5)),
        ((slanted, normal), (0, 1)),
    ]:
        assert tuple(float(w[2]) for w in by_height(*pair)) == expected


def test_direction_has_the_angles_it_was_given():
    w = geometry.direction(jnp.float32(0.4), jnp.float32(2.0))
    x, y, z = np.asarray(w, float)
    assert np.arccos(z) == pytest.approx(0.4, rel=1e-5)
    assert np.arctan2(y, x) == pytest.approx(2.0, rel=1e-5)
    assert float(geometry.cos_theta(w)) == pytest.approx(np.cos(0.4), rel=1e-6)


def test_rotation_takes_the_normal_to_the_axis_and_keeps_angles(pairs):
    axis, w = pairs
    turned = each(geometry.rotate_to)
    np.testing.assert_allclose(
        turned(axis, jnp.tile(NORMAL, (len(axis), 1))), axis, atol=1e-6
    )
    to_axis = np.sum(np.asarray(axis) * turned(axis, w), axis=1)
    np.testing.assert_allclose(to_axis, w[:, 2], atol=1e-6)


def test_shading_frame_is_right_handed_and_starts_at_the_tangent(pairs):
    normal, tangent = pairs
    frames = np.asarray(each(geometry.shading_frame)(normal, tangent), float)
    np.testing.assert_allclose(
        frames @ frames.transpose(0, 2, 1), np.tile(np.eye(3), (50, 1, 1)), atol=2e-6
    )
    np.testing.assert_allclose(np.linalg.det(frames), 1, rtol=1e-5)
    np.testing.assert_allclose(frames[:, 2], normal, atol=1e-6)
    local = np.einsum("nij,nj->ni", frames, np.asarray(tangent, float))
    assert np.all(local[:, 0] > 0)
    np.testing.assert_allclose(local[:, 1], 0, atol=2e-6)


def test_cylindrical_tangent_runs_around_the_y_axis(pairs):
    normal, _ = pairs
    tangent = np.asarray(each(geometry.cylindrical_tangent)(normal), float)
    np.testing.assert_allclose(np.sum(tangent * normal, axis=1), 0, atol=1e-6)
    assert np.all(tangent[:, 1] == 0)
    np.testing.assert_allclose(np.linalg.norm(tangent, axis=1), 1, rtol=1e-6)
    assert jnp.allclose(geometry.cylindrical_tangent(NORMAL), jnp.array([1.0, 0, 0]))
    on_the_axis = geometry.cylindrical_tangent(jnp.array([0.0, 1.0, 0.0]))
    assert np.all(np.isfinite(on_the_axis))


@pytest.mark.parametrize("field", geometry.TANGENTS)
def test_tangents_are_unit_vectors_on_the_surface(field, pairs):
    normal, _ = pairs
    tangent = np.asarray(each(geometry.TANGENTS[field])(normal), float)
    np.testing.assert_allclose(np.sum(tangent * normal, axis=1), 0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(tangent, axis=1), 1, rtol=1e-6)
    towards_x = geometry.TANGENTS[field](NORMAL)
    np.testing.assert_allclose(towards_x, [1, 0, 0], atol=1e-7)


def test_linear_tangent_has_no_part_across_the_x_axis(pairs):
    normal, _ = pairs
    tangent = np.asarray(each(geometry.linear_tangent)(normal), float)
    across = np.cross(normal, [1.0, 0.0, 0.0])
    np.testing.assert_allclose(np.sum(tangent * across, axis=1), 0, atol=1e-6)
    assert np.all(tangent[:, 0] > 0)


def test_radial_tangent_leaves_the_z_axis(pairs):
    normal, _ = pairs
    tangent = np.asarray(each(geometry.radial_tangent)(normal), float)
    assert np.all(np.sum(tangent[:, :2] * normal[:, :2], axis=1) > 0)
    turned = tangent[:, 0] * normal[:, 1] - tangent[:, 1] * normal[:, 0]
    np.testing.assert_allclose(turned, 0, atol=1e-6)
