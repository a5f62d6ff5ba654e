"""Bumps, holes, and where maps lie on a surface."""

import numpy as np
import pytest
import trimesh

from brdffit.effects import bump, cut_out, falloff
from brdffit.effects.placing import coordinates
from brdffit.scene import Geometry, HeightMap, Mesh, OpacityMap, Plane, Point, Sphere

V, U = (np.mgrid[0:256, 0:512] + 0.5) / [[[256]], [[512]]]
HEIGHT = HeightMap(np.sin(2 * np.pi * 3 * U) * np.sin(np.pi * V) ** 2, scale=0.05)


def rays_onto_a_sphere(count, seed=0):
    random = np.random.default_rng(seed)
    start = random.standard_normal((count, 3))
    start *= 3 / np.linalg.norm(start, axis=1, keepdims=True)
    return start, -start / 3


def test_normals_of_a_bumpy_sphere_are_those_of_the_displaced_surface():
    sphere = Sphere([0.3, 0, 0], 2.0, height=HEIGHT)
    geometry = Geometry([sphere])
    start, towards = rays_onto_a_sphere(300)
    hits = geometry.first_hits(start * 2 + [0.3, 0, 0], towards)
    hits = hits.take(np.abs(hits.normal[:, 1]) < 0.95)  # poles apart

    def surface(u, v):
        """The displaced surface, as far as the height is small."""
        phi, theta = 2 * np.pi * u, np.pi * v
        out = [np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)]
        out = np.stack(out)
        height = 0.05 * np.sin(6 * np.pi * u) * np.sin(np.pi * v) ** 2
        return ((2 + 1e-3 * height) * out).T

    place, _, _ = coordinates(sphere, hits)
    u, v = place.T
    step = 1e-5
    by_u = surface(u + step, v) - surface(u - step, v)
    by_v = surface(u, v + step) - surface(u, v - step)
    expected = np.cross(by_u, by_v)
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    expected *= np.sign(np.sum(expected * hits.normal, axis=1))[:, None]
    small = Sphere(sphere.centre, 2.0, height=HeightMap(HEIGHT.map, 0.05e-3))
    found = bump.normals(Geometry([small]), hits)
    tilt = np.abs(expected - hits.normal).max()
    assert np.abs(found - expected).max() < 0.02 * tilt


def test_heights_stand_out_of_the_side_that_is_seen():
    """A slope that rises along x leans the normal back, from above and from below."""
    ramp = Plane(height=HeightMap(np.abs(np.linspace(-1, 1, 200))[None], repeat=0.5))
    geometry = Geometry([ramp])
    origin = np.array([[1.5, 2.0, 0.0], [1.5, -2.0, 0.0]])
    hits = geometry.first_hits(origin, np.array([[0, -1.0, 0], [0, 1, 0]]))
    found = bump.normals(geometry, hits)
    slope = 1 * 2 / 1 * 0.5
    length = np.hypot(1, slope)
    np.testing.assert_allclose(found[0], [-slope / length, 1 / length, 0], rtol=0.02)
    np.testing.assert_allclose(found[1], [slope / length, -1 / length, 0], rtol=0.02)


def test_coordinates_of_a_mesh_are_those_of_its_file(tmp_path):
    text = "v 0 0 0\nv 2 0 0\nv 0 0 -2\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    (tmp_path / "a.obj").write_text(text)
    height = HeightMap(U * 0 + V, scale=0.1)
    mesh = Mesh(tmp_path / "a.obj", height=height)
    geometry = Geometry([mesh])
    origin = np.array([[0.5, 1.0, -0.5]])
    hits = geometry.first_hits(origin, np.array([[0, -1.0, 0]]))
    place, along_u, along_v = coordinates(mesh, hits)
    np.testing.assert_allclose(place, [[0.25, 0.75]], atol=1e-12)
    np.testing.assert_allclose(along_u, [[0.5, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(along_v, [[0, 0, 0.5]], atol=1e-12)
    # the height falls with -z, by 0.1 over 2
    (found,) = bump.normals(geometry, hits)
    np.testing.assert_allclose(found[2] / found[1], -0.05, rtol=1e-6)


def test_a_level_map_changes_nothing():
    sphere = Sphere(height=HeightMap(np.ones((4, 8))))
    geometry = Geometry([sphere])
    hits = geometry.first_hits(*rays_onto_a_sphere(20))
    np.testing.assert_allclose(bump.normals(geometry, hits), hits.normal, rtol=1e-12)


def test_rays_pass_holes_to_what_is_behind():
    upper = OpacityMap(np.array([[0.0], [0.0], [1.0], [1.0]]))
    geometry = Geometry([Sphere(opacity=upper), Sphere(radius=0.5)])
    origin = np.array([[0, 0.3, 5], [0, -0.3, 5], [0, 0.8, 5], [0, 0.95, -5]])
    towards = np.tile([0, 0, -1.0], (4, 1))
    towards[3] = [0, 0, 1.0]
    hits = cut_out.first_hits(geometry, origin, towards)
    np.testing.assert_array_equal(hits.ray, [0, 1])
    np.testing.assert_array_equal(hits.shape, [1, 0])
    np.testing.assert_allclose(hits.distance, [5 - 0.4, 5 - 0.91**0.5], rtol=1e-9)


def test_the_inside_of_a_sphere_is_seen_through_a_hole():
    half = OpacityMap(np.array([[0.0, 0.0, 1.0, 1.0]]).repeat(2, axis=0))
    geometry = Geometry([Sphere(opacity=half)])
    hits = cut_out.first_hits(
        geometry, np.array([[5.0, 0, 0.1]]), np.array([[-1.0, 0, 0]])
    )
    assert hits.inside.all()
    np.testing.assert_allclose(hits.position, [[-(0.99**0.5), 0, 0.1]], atol=1e-12)
    assert hits.normal[0, 0] > 0


@pytest.mark.parametrize("distance", [0.5, 3.0])
def test_light_of_a_point_falls_off_with_the_square_of_the_distance(distance):
    light = Point([0, 0, distance], [1.0, 2.0])
    towards, irradiance, away = falloff.from_point(light, np.zeros((1, 3)), 2, None)
    np.testing.assert_allclose(towards[0, 0], [0, 0, 1])
    np.testing.assert_allclose(irradiance[0, 0], np.array([1, 2]) / distance**2)
    np.testing.assert_allclose(away, distance)


def test_a_point_on_a_light_receives_nothing_rather_than_infinity():
    light = Point([0, 0, 0])
    _, irradiance, _ = falloff.from_point(light, np.zeros((1, 3)), 1, None)
    assert irradiance == 0


def test_a_round_mesh_is_convex():
    ball = trimesh.creation.icosphere(1)
    assert Mesh((ball.vertices, ball.faces)).convex
    assert not Mesh((ball.vertices, ball.faces[1:])).convex
