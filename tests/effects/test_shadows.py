import numpy as np
import pytest

from brdffit.effects import plan, shadows
from brdffit.effects.lights import incident
from brdffit.models import MODELS
from brdffit.render import trace
from brdffit.scene import (
    Directional,
    Environment,
    Geometry,
    Mesh,
    OpacityMap,
    Orthographic,
    Perspective,
    Plane,
    Point,
    Scene,
    ShadowMap,
    Sphere,
)

GREY = MODELS["lambert"]()
ABOVE = Orthographic(96, towards=[0, 1, 0], up=[0, 0, -1], height=6)
BALL = Sphere([0.0, 1.0, 0.0], 0.8, material=GREY)
FLOOR = Plane()
LIGHTS = {
    "directional": Directional([0.6, 0.8, 0.0]),
    "point": Point([1.0, 4.0, 0.5], 10.0),
}


def lit_floor(light, how, ball=BALL):
    """Whether points of the floor are lit, and where they are."""
    scene = Scene(ABOVE, (FLOOR, ball), (light,), shadows=how)
    samples = trace(scene)
    x = 3 * ((2 * samples.pixels.column + 1) / 96 - 1)
    z = 3 * ((2 * samples.pixels.row + 1) / 96 - 1)
    place = np.stack([x, 0 * x, z], axis=1)
    return samples.weight[:, 0, 0] > 0, place


def in_shadow(light, place):
    """Whether the line from a point to the light passes through the ball."""
    if isinstance(light, Directional):
        towards = np.broadcast_to(light.direction, place.shape)
    else:
        towards = light.position - place
        towards = towards / np.linalg.norm(towards, axis=1, keepdims=True)
    beside = np.cross(BALL.centre - place, towards)
    return np.linalg.norm(beside, axis=1) < BALL.radius


@pytest.mark.parametrize("kind", LIGHTS)
def test_rays_find_the_exact_shadow(kind):
    lit, place = lit_floor(LIGHTS[kind], Scene.shadows)
    dark = in_shadow(LIGHTS[kind], place)
    np.testing.assert_array_equal(lit, ~dark)
    assert 0.02 < dark.mean() < 0.4


@pytest.mark.parametrize("kind", LIGHTS)
def test_maps_come_closer_to_it_with_every_pixel(kind):
    wrong = []
    for resolution in (16, 64, 256):
        lit, place = lit_floor(LIGHTS[kind], ShadowMap(resolution))
        wrong.append(np.mean(lit == in_shadow(LIGHTS[kind], place)))
    assert wrong[0] > 2 * wrong[1] > 2 * wrong[2]
    assert wrong[2] < 0.003


@pytest.mark.parametrize("kind", LIGHTS)
def test_the_bias_keeps_a_lit_surface_free_of_its_own_shadow(kind):
    """Without a bias the floor darkens itself; with it no lit point is lost."""
    small = Sphere([0, 0.3, 0], 0.3)
    for slope_bias, bias, clean in ((1.0, 0.05, True), (0.0, 0.0, False)):
        how = ShadowMap(32, slope_bias, bias)
        scene = Scene(ABOVE, (small,), (LIGHTS[kind],), shadows=how)
        made = plan(scene, with_=["shadows"])
        samples = trace(scene, made)
        facing = samples.wi[:, 0, 2] > 0.05
        assert (samples.weight[facing, 0, 0] > 0).all() == clean


def test_the_constant_bias_keeps_a_hollow_sphere_lit_from_its_centre():
    """All depths are equal there and nothing slants: rounding alone decides."""
    camera = Perspective(24, position=[0, 0, 0.5], field_of_view=90)
    for bias, clean in ((0.05, True), (0.0, False)):
        how = ShadowMap(32, 1.0, bias)
        lamp = Point([0.0, 0.0, 0.0])
        scene = Scene(camera, (Sphere(),), (lamp,), shadows=how)
        samples = trace(scene, plan(scene, with_=["shadows"]))
        assert len(samples.wo) == 24**2
        assert (samples.weight[:, 0, 0] > 0).all() == clean


@pytest.mark.parametrize("light", [Directional([0, 1, 0]), Point([0, 4, 0])])
def test_the_bias_is_no_larger_than_it_must_be(light):
    """A card close above a floor leaves all below it dark, and nothing around it."""
    card = Mesh(([[-1, 0.05, -1], [1, 0.05, -1], [0, 0.05, 1]], [[0, 1, 2]]))
    scene = Scene(ABOVE, (FLOOR, card), (light,), shadows=ShadowMap(64))
    geometry = Geometry(scene.shapes)
    below = [[0, 0.02, 0], [-0.6, 0.02, -0.8], [0.6, 0.02, -0.8]]
    beside = [[-1.8, 0.02, -0.8], [0, 0.02, 1.5]]
    down = np.tile([0.0, -1.0, 0.0], (5, 1))
    hits = geometry.first_hits(np.array([*below, *beside]), down)
    towards = incident(scene.lights, hits.position, 1, None)
    lit = shadows.visibility(geometry, geometry.first_hits, hits, towards, scene)
    np.testing.assert_array_equal(lit[:, 0], [0, 0, 0, 1, 1])


def test_light_passes_through_holes():
    holes = OpacityMap(np.tile([0.0, 1.0], (4, 8)))
    whole, _ = lit_floor(LIGHTS["directional"], Scene.shadows)
    full, _ = lit_floor(LIGHTS["point"], Scene.shadows)
    ball = Sphere(BALL.centre, BALL.radius, material=GREY, opacity=holes)
    striped, _ = lit_floor(LIGHTS["point"], Scene.shadows, ball)
    assert full.sum() < striped.sum() < len(striped)
    assert whole.sum() < len(whole)


def test_a_mesh_casts_its_own_shadow_on_itself():
    """Two walls at a right angle: the upper one darkens a strip of the lower one."""
    vertices = [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [-1, 1, -1], [-1, 1, 1]]
    faces = [[0, 2, 1], [0, 3, 2], [0, 4, 5], [0, 5, 3]]
    sun = Directional([-0.6, 0.8, 0.0])
    camera = Orthographic(40, towards=[0, 1, 0], up=[0, 0, -1])
    samples = trace(Scene(camera, (Mesh((vertices, faces)),), (sun,)))
    x = (2 * samples.pixels.column + 1) / 40 - 1
    np.testing.assert_array_equal(samples.weight[:, 0, 0] > 0, x > -1 + 0.75)


def test_a_probe_is_hidden_by_what_stands_before_it():
    """A floor below half of the sky receives half of its light."""
    sky = np.ones((16, 32, 1))
    wall = Mesh(([[0, 0, -500], [0, 0, 500], [0, 900, 0]], [[0, 1, 2]]), material=GREY)
    camera = Orthographic(2, towards=[0, 1, 0], up=[0, 0, -1], target=[0.1, 0, 0])
    scene = Scene(camera, (FLOOR, wall), (Environment(sky),))
    samples = trace(scene, plan(scene, GREY, tolerance=0.01))
    beside = np.abs(samples.weight[:, :, 0].sum(axis=1) - np.pi / 2)
    assert beside.max() < 0.02 * np.pi
