import numpy as np
import pytest

from brdffit.effects import environment, plan
from brdffit.effects.quadrature import Regions, texels
from brdffit.models import MODELS
from brdffit.render import picture, render, trace
from brdffit.render.shading import compiled_shade
from brdffit.scene import (
    Directional,
    Environment,
    OpacityMap,
    Orthographic,
    Plane,
    Scene,
    Sphere,
)

ROWS, COLUMNS = 64, 128
GREY = MODELS["lambert"](albedo=[0.5, 0.5, 0.5])


def sky():
    """A probe with a gradient, a soft sun and a black half, in colours."""
    v, u = (np.mgrid[0:ROWS, 0:COLUMNS] + 0.5) / [[[ROWS]], [[COLUMNS]]]
    y, phi = np.cos(np.pi * v), 2 * np.pi * u
    z = -np.sin(np.pi * v) * np.cos(phi)
    sun = 30 * np.exp(40 * (0.6 * y + 0.8 * z - 1))
    pixels = (1 + y)[..., None] * [0.2, 0.3, 0.5] + sun[..., None] * [1.0, 0.9, 0.7]
    return pixels * (u > 0.25)[..., None]


@pytest.fixture(scope="module")
def regions():
    return Regions(Environment(sky()))


def test_energy_is_exact_for_any_number_of_directions(regions):
    whole = texels(Environment(sky()))[0].sum(axis=(0, 1))
    for count in (1, 5, 64, 1000):
        rule = regions.rule(count)
        assert len(rule.towards) == count
        np.testing.assert_allclose(rule.irradiance.sum(axis=0), whole, rtol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(rule.towards, axis=1), 1, rtol=1e-12)


def test_a_rule_does_not_depend_on_what_was_asked_before(regions):
    fresh = Regions(Environment(sky())).rule(100)
    np.testing.assert_array_equal(regions.rule(100).towards, fresh.towards)


def test_directions_are_where_the_light_is(regions):
    near_sun = regions.rule(256).towards @ [0.0, 0.6, 0.8] > 0.9
    assert near_sun.mean() > 0.1


def test_a_probe_of_a_few_pixels_is_used_up():
    rule = Regions(Environment(np.ones((2, 4, 1)))).rule(500)
    assert len(rule.towards) == 8
    assert rule.irradiance.sum() == pytest.approx(4 * np.pi, rel=1e-12)


def test_with_as_many_directions_as_pixels_the_rule_is_the_probe(regions):
    light, direction = texels(Environment(sky()))
    lit = light.any(axis=-1)
    rule = regions.rule(ROWS * COLUMNS)
    assert 0 < len(rule.towards) < ROWS * COLUMNS
    np.testing.assert_array_equal(rule.irradiance, light[lit])
    np.testing.assert_allclose(rule.towards, direction[lit], atol=1e-15)


def test_more_directions_than_are_cut_are_squares_of_pixels(monkeypatch):
    monkeypatch.setattr("brdffit.effects.quadrature.CUTS", 64)
    pixels = np.random.default_rng(0).uniform(1, 2, (15, 30, 1))
    probe = Environment(pixels)
    rule = Regions(probe).rule(449)  # one less than there are pixels
    assert len(rule.towards) == 8 * 15
    light, direction = (a[:2, :2].reshape(4, -1) for a in texels(probe))
    assert rule.irradiance[0, 0] == pytest.approx(light.sum(), rel=1e-12)
    middle = (light * direction).sum(axis=0)
    np.testing.assert_allclose(rule.towards[0], middle / np.linalg.norm(middle))
    assert len(Regions(probe).rule(64).towards) == 64


def test_a_single_bright_pixel_is_one_direction():
    pixels = np.zeros((32, 64, 1))
    pixels[10, 20] = 1000.0
    rule = Regions(Environment(pixels)).rule(16)
    light, direction = texels(Environment(pixels))
    assert light.sum() == pytest.approx(rule.irradiance.sum(), rel=1e-12)
    assert (rule.towards @ direction[10, 20] > 0.99).all()


def test_a_white_surface_under_an_even_sky_shows_its_albedo():
    even = Scene(Orthographic(12), (Sphere(),), (Environment(np.ones((32, 64, 1))),))
    image = render(GREY, even, plan(even, GREY, tolerance=1e-3))
    samples = trace(even, plan(even, tolerance=0.1))
    inside = samples.pixels.images(np.ones((len(samples), 1)), 0.0)[0, ..., 0] > 0
    np.testing.assert_allclose(image[inside], 0.5, rtol=3e-3)
    np.testing.assert_allclose(image[~inside], 1, rtol=1e-6)


@pytest.mark.parametrize("alpha", [0.03, 0.15, 0.5])
def test_the_count_of_the_plan_meets_its_tolerance(alpha):
    """Against every pixel of the probe, on pixels that the plan has not looked at."""
    brdf = MODELS["ggx"](diffuse=0.2, f0=[0.3, 0.2, 0.1], alpha=alpha)
    scene = Scene(Orthographic(9), (Sphere(),), (Environment(sky()),))
    counts = []
    for tolerance in (0.1, 0.01, 0.001):
        made = plan(scene, brdf, tolerance=tolerance)
        samples = trace(scene, made)
        light, direction = texels(scene.probe)
        every = type(made.sky)(direction.reshape(-1, 3), light.reshape(-1, 3))
        exact = trace(scene, type(made)(made.decisions, tolerance, every))
        found, truth = (np.asarray(compiled_shade(brdf, s)) for s in (samples, exact))
        error = np.sqrt(np.mean((found - truth) ** 2) / np.mean(truth**2))
        assert error < tolerance
        counts.append(made.directions)
    assert counts[0] < counts[2]
    assert counts == sorted(counts)


def sharp_and_rough(tolerance):
    """Plans for a lobe narrower than the pixels of the sky, and for a wide one."""
    scene = Scene(Orthographic(9), (Sphere(),), (Environment(sky()),))
    return [
        plan(scene, MODELS["ggx"](f0=[0.5] * 3, alpha=alpha), tolerance=tolerance)
        for alpha in (0.005, 0.6)
    ]


def test_a_lobe_that_is_too_sharp_for_fewer_takes_every_pixel():
    sharp, rough = sharp_and_rough(3e-4)
    assert sharp.directions > rough.directions
    assert f"all of its {ROWS * COLUMNS} pixels" in sharp.decisions["environment"].why
    assert f"by {rough.directions} directions" in rough.decisions["environment"].why


def test_a_probe_of_too_many_pixels_for_the_tolerance_is_told(monkeypatch):
    monkeypatch.setattr(environment, "MOST", ROWS * COLUMNS // 4)
    plans = sharp_and_rough(1e-2)
    sharp, rough = (made.decisions["environment"].why for made in plans)
    assert "or above it: more pixels of it would be needed" in sharp
    assert "needed" not in rough


def test_a_model_that_is_not_known_is_told():
    scene = Scene(Orthographic(9), (Sphere(),), (Environment(sky()),))
    assert "as the BRDF is not known yet" in plan(scene).decisions["environment"].why


def test_a_probe_that_is_seen_through_holes_only_counts_in_full():
    """Its light on the wall does not count beside that of the sun."""
    sun, probe = Directional([0, 0, 1], 1e5), Environment(np.ones((4, 8, 1)))
    holes = OpacityMap(np.tile([0.0, 1.0], (4, 8)))
    for opacity, on in ((None, False), (holes, True)):
        wall = Plane([0, 0, 0], [0, 0, 1], opacity=opacity)
        made = plan(Scene(Orthographic(12), (wall,), (sun, probe)), GREY)
        assert made.on("environment") == on


def test_a_picture_takes_few_points_at_once_under_many_directions(monkeypatch):
    """So its memory is bounded: by the points of a block, times the directions."""
    scene = Scene(Orthographic(9), (Sphere(),), (Environment(sky()),))
    made = plan(scene, GREY, tolerance=0.01)
    whole, sizes = render(GREY, scene, made), []

    def counted(brdf, samples):
        sizes.append(samples.weight.shape[:2])
        return compiled_shade(brdf, samples)

    monkeypatch.setattr(picture, "compiled_shade", counted)
    monkeypatch.setattr(picture, "PAIRS", 16 * made.directions)
    np.testing.assert_allclose(render(GREY, scene, made), whole, rtol=1e-5)
    assert set(sizes) <= {(16, made.directions), (8, made.directions)}


def test_where_no_surface_is_seen_nothing_is_said_of_all_pixels():
    camera = Orthographic(5, target=[9, 0, 0])
    made = plan(Scene(camera, (Sphere(),), (Environment(sky()),)), GREY)
    assert "by 16 directions" in made.decisions["environment"].why
