import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.scene import intersection

CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


@jax.jit
def _sphere(origin, direction):
    zero = jnp.zeros(3)
    return intersection.sphere(origin, direction, zero, jnp.ones(()), jnp.zeros(()))


@jax.jit
def _triangles(origin, direction, corners):
    each = jax.vmap(intersection.triangle, (None, None, 0, None))
    return jax.vmap(each, (0, 0, None, None))(
        origin, direction, corners, jnp.asarray(1e-12)
    )


def meet_sphere(origin, direction):
    with jax.enable_x64(True):
        arrays = jnp.asarray(origin, float), jnp.asarray(direction, float)
        return tuple(np.asarray(a) for a in _sphere(*arrays))


def meet_triangles(origin, direction, corners):
    with jax.enable_x64(True):
        arrays = (np.asarray(a, float) for a in (origin, direction, corners))
        return tuple(np.asarray(a) for a in _triangles(*arrays))


def test_a_ray_meets_the_near_side_of_a_sphere():
    distance, normal = meet_sphere([0.6, 0, 5], [0, 0, -1])
    assert distance == pytest.approx(4.2, rel=1e-15)
    np.testing.assert_allclose(normal, [0.6, 0, 0.8], atol=1e-15)


def test_an_oblique_ray_meets_the_near_side():
    distance, normal = meet_sphere([-3, 0, 0.6], [1, 0, 0])
    assert distance == pytest.approx(2.2, rel=1e-15)
    np.testing.assert_allclose(normal, [-0.8, 0, 0.6], atol=1e-15)


def test_a_ray_from_within_meets_the_far_side():
    distance, normal = meet_sphere([0, 0, 0.5], [0, 0, -1])
    assert distance == pytest.approx(1.5, rel=1e-15)
    np.testing.assert_allclose(normal, [0, 0, -1], atol=1e-15)


def test_a_far_ray_loses_no_digits():
    _, normal = meet_sphere([0.6, 0, 1e8], [0, 0, -1])
    np.testing.assert_allclose(normal, [0.6, 0, 0.8], atol=1e-15)


@pytest.mark.parametrize(
    ("origin", "direction"),
    [([1.1, 0, 5], [0, 0, -1]), ([1, 0, 5], [0, 0, -1]), ([0, 0, 5], [0, 0, 1])],
    ids=["beside", "touching", "away"],
)
def test_a_ray_beside_touching_or_leaving_misses(origin, direction):
    distance, _ = meet_sphere(origin, direction)
    assert distance == np.inf


def test_a_triangle_is_met_from_both_sides_with_the_weights_of_its_corners():
    origin = [[0.2, 0.3, 2.0], [0.2, 0.3, -2.0]]
    direction = [[0, 0, -1], [0, 0, 1]]
    distance, u, v = meet_triangles(origin, direction, [CORNERS])
    np.testing.assert_allclose(distance[:, 0], 2, rtol=1e-15)
    np.testing.assert_allclose([u[:, 0], v[:, 0]], [[0.2] * 2, [0.3] * 2], rtol=1e-14)


@pytest.mark.parametrize(
    ("origin", "direction"),
    [([0.6, 0.6, 1], [0, 0, -1]), ([-0.1, 0.1, 1], [0, 0, -1]), ([0, 0, 1], [0, 0, 1])],
    ids=["beyond the long edge", "beside a short one", "away"],
)
def test_a_ray_beside_a_triangle_misses(origin, direction):
    assert meet_triangles([origin], [direction], [CORNERS])[0] == np.inf


def test_a_triangle_seen_edge_on_has_no_width():
    grazing = [np.cos(1e-9), 0, -np.sin(1e-9)]
    origin = [[-1, 0.2, 0], [-1, 0.2, 1.2e-9]]
    distance, _, _ = meet_triangles(origin, [[1, 0, 0], grazing], [CORNERS])
    assert distance[0, 0] == np.inf
    assert distance[1, 0] == pytest.approx(1.2, rel=1e-6)


def test_rounding_gives_no_width_to_triangles_seen_edge_on():
    """Rays in the planes of random triangles, aimed at the middle of each."""
    random = np.random.default_rng(4)
    corners = random.standard_normal((300, 3, 3))
    middle = corners.mean(axis=1)
    along = corners[:, 0] + 3 * (corners[:, 1] - corners[:, 0]) - middle
    direction = -along / np.linalg.norm(along, axis=1, keepdims=True)
    distance, _, _ = meet_triangles(middle + along, direction, corners)
    assert (np.diagonal(distance) == np.inf).all()


@pytest.mark.parametrize(
    ("direction", "expected"),
    [([0.6, -0.8, 0], 2.5), ([0.6, 0.8, 0], np.inf), ([1, 0, 0], np.inf)],
    ids=["towards", "away", "along"],
)
def test_a_plane_is_met_where_the_ray_goes_towards_it(direction, expected):
    arrays = [np.array(a, float) for a in ([0, 2, 0], direction, [5, 0, 7], [0, 1, 0])]
    with jax.enable_x64(True):
        arrays = [jnp.asarray(a) for a in arrays]
        distance = intersection.plane(*arrays, jnp.zeros(()))
    assert float(distance) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_far_triangle_is_met_where_it_is_whatever_its_size(scale):
    far = 1e6 * scale
    origin = np.array([0.25, 0.25, 0.0]) * scale
    away = np.array([0.6, 0, 0.8])
    origin = origin + far * away
    distance, u, v = meet_triangles([origin], [-away], [CORNERS * scale])
    assert distance[0, 0] == pytest.approx(far, rel=1e-9)
    np.testing.assert_allclose([u[0, 0], v[0, 0]], 0.25, atol=1e-9)


def test_nothing_leaks_between_triangles_that_share_an_edge():
    """Rays through the diagonals of a fan of quadrangles, from near and far."""
    random = np.random.default_rng(2)
    a, b, c, d = random.standard_normal((4, 3)) * [1, 1, 0.1]
    corners = [[a, b, c], [c, b, d]]
    share = random.random((4000, 1))
    edge = b + share * (c - b)
    towards = random.standard_normal((4000, 3))
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    normal = np.cross(b - a, c - a)
    slant = np.abs(towards @ normal) / np.linalg.norm(normal) > 0.05
    far = 10.0 ** random.uniform(0, 6, (4000, 1))
    distance, _, _ = meet_triangles(edge - far * towards, towards, corners)
    met = np.any(np.isfinite(distance), axis=1)
    assert np.all(met[slant])


def test_many_random_triangles_agree_with_the_plane_and_three_edges():
    random = np.random.default_rng(3)
    corners = random.standard_normal((50, 3, 3))
    origin = random.standard_normal((40, 3)) * 3
    direction = -origin / np.linalg.norm(origin, axis=1, keepdims=True)
    distance, _, _ = meet_triangles(origin, direction, corners)
    for n in range(40):
        for t in range(50):
            a, b, c = corners[t]
            system = np.stack([-direction[n], b - a, c - a], axis=1)
            s, u, v = np.linalg.solve(system, origin[n] - a)
            hit = u > 0 and v > 0 and u + v < 1 and s > 0
            assert np.isfinite(distance[n, t]) == hit
            if hit:
                assert distance[n, t] == pytest.approx(s, rel=1e-9)
