import numpy as np
import pytest
import trimesh

from brdffit.scene import Geometry, HeightMap, Mesh, Sphere, embree

SQUARE = ([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize("suffix", ["obj", "ply", "glb", "stl"])
def test_meshes_are_read_from_files(tmp_path, suffix):
    path = tmp_path / f"ball.{suffix}"
    trimesh.creation.icosphere(1).export(path)
    mesh = Mesh(path, scale=2.0, position=[1, 0, 0])
    assert mesh.corners.shape == (80, 3, 3)
    away = np.linalg.norm(mesh.corners - [1, 0, 0], axis=-1)
    np.testing.assert_allclose(away, 2, rtol=1e-5)
    assert suffix == "stl" or mesh.convex


@pytest.mark.parametrize(
    ("source", "sentence"),
    [
        ("none.obj", "`file`: mesh `none.obj` does not exist"),
        (([[0, 0, 0]], [[0, 0, 3]]), "`file` must be a mesh file, or vertices"),
        (([[0, 0, 0]], np.zeros((0, 3), int)), "`file`: the mesh has no triangle"),
        (([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]), "1 triangles without area"),
        (([[0, 0, np.nan], [1, 0, 0], [2, 1, 0]], [[0, 1, 2]]), "is not finite"),
        (5, "`file` must be a mesh file"),
    ],
)
def test_a_mesh_that_is_none_is_refused(source, sentence):
    with pytest.raises((ValueError, OSError), match=sentence):
        Mesh(source)


def test_a_damaged_file_gets_a_sentence(tmp_path):
    for name, content in [
        ("a.ply", b"ply\nformat"),
        ("b.glb", b"glTF"),
        ("c.obj", b""),
    ]:
        (tmp_path / name).write_bytes(content)
        with pytest.raises((OSError, ValueError), match=name):
            Mesh(tmp_path / name)


def test_maps_need_coordinates():
    with pytest.raises(ValueError, match="`height` needs texture coordinates"):
        Mesh(SQUARE, height=HeightMap([[0.0, 1.0]]))


def test_first_hits_choose_the_nearest_of_all_kinds():
    square = Mesh(SQUARE, position=[0, 0, 2])
    geometry = Geometry([Sphere(), square, Sphere([3, 0, 0])])
    origin = np.array([[0, 0, 9.0], [3, 0, 9], [0, 0, -9], [9, 9, 9]])
    towards = np.array([[0, 0, -1.0], [0, 0, -1], [0, 0, 1], [0, 0, -1]])
    hits = geometry.first_hits(origin, towards)
    np.testing.assert_array_equal(hits.ray, [0, 1, 2])
    np.testing.assert_array_equal(hits.shape, [1, 2, 0])
    np.testing.assert_allclose(hits.distance, [7, 8, 8], rtol=1e-12)
    np.testing.assert_allclose(hits.geometric, -towards[:3], atol=1e-15)


def test_normals_of_a_smooth_mesh_are_between_those_of_its_corners():
    ball = trimesh.creation.icosphere(3)
    source = (ball.vertices, ball.faces)
    origin = np.array([[0.3, 0.2, 5.0], [-0.5, 0.1, 5.0]])
    towards = np.tile([0, 0, -1.0], (2, 1))
    exact = Geometry([Sphere()]).first_hits(origin, towards).normal
    smooth = Geometry([Mesh(source, smooth=True)]).first_hits(origin, towards)
    flat = Geometry([Mesh(source)]).first_hits(origin, towards)
    assert np.abs(smooth.normal - exact).max() < 4e-3
    assert np.abs(flat.normal - exact).max() > 0.02
    np.testing.assert_array_equal(smooth.geometric, flat.normal)


@pytest.mark.parametrize(("subdivisions", "large"), [(3, False), (4, True)])
def test_embree_takes_meshes_beyond_a_few_thousand_triangles(subdivisions, large):
    ball = trimesh.creation.icosphere(subdivisions)
    assert len(ball.faces) in (1280, 5120)
    assert bool(Geometry([Mesh((ball.vertices, ball.faces))]).large) == large


def test_a_large_mesh_is_met_by_embree_where_a_small_one_is(monkeypatch):
    ball = trimesh.creation.icosphere(3)
    mesh = Mesh((ball.vertices, ball.faces))
    random = np.random.default_rng(5)
    origin = random.standard_normal((200, 3)) * 3
    towards = random.standard_normal((200, 3)) * 0.3 - origin
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    here = Geometry([mesh])
    monkeypatch.setattr(embree, "MANY", 100)
    there = Geometry([mesh])
    assert there.large
    assert not here.large
    one, other = here.first_hits(origin, towards), there.first_hits(origin, towards)
    np.testing.assert_array_equal(one.ray, other.ray)
    np.testing.assert_allclose(one.position, other.position, atol=1e-12)
    points, light = one.position, np.array([[[0.6, 0.0, 0.8]]])
    far = np.full((1, 1), np.inf)
    np.testing.assert_array_equal(
        here.blocked(points, light, far), there.blocked(points, light, far)
    )
