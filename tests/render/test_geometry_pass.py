import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.effects.plan import plan_for_tracing
from brdffit.models import MODELS
from brdffit.render import (
    geometry_pass,
    materials_of,
    radiance,
    render,
    trace,
    trace_paths,
)
from brdffit.render.plain import is_plain
from brdffit.scene import (
    Ambient,
    Directional,
    Environment,
    Geometry,
    Orthographic,
    Plane,
    Point,
    Scene,
    Sphere,
    lit_sphere,
)

LIGHTS = ((-0.48, 0.6, 0.64), (0.8, 0.0, -0.6))
SIZE = 31


@pytest.fixture(scope="module")
def samples():
    return trace(lit_sphere(SIZE, LIGHTS, [1.0, 2.0, 3.0], exposure=0.5))


@pytest.fixture(scope="module")
def normal(samples):
    x = (2 * samples.pixels.column + 1) / SIZE - 1
    y = 1 - (2 * samples.pixels.row + 1) / SIZE
    return np.stack([x, y, np.sqrt(1 - x * x - y * y)], axis=-1)


def test_every_pixel_whose_centre_sees_the_sphere_is_a_sample(samples):
    centre = (2 * np.arange(SIZE) + 1) / SIZE - 1
    inside = centre[:, None] ** 2 + centre**2 < 1
    found = samples.pixels.images(np.ones((len(samples), 1)), background=0.0)[0, ..., 0]
    np.testing.assert_array_equal(found.astype(bool), inside)
    assert samples.pixels.shape == (1, SIZE, SIZE)
    assert samples.value is None


def test_directions_are_exact_to_float32_and_of_unit_length(samples, normal):
    assert samples.wi.dtype == samples.wo.dtype == samples.weight.dtype == np.float32
    np.testing.assert_allclose(samples.wo[:, 2], normal[:, 2], rtol=2e-7)
    np.testing.assert_allclose(samples.wi[:, :, 2], normal @ np.transpose(LIGHTS), 2e-7)
    for w in (samples.wo, samples.wi):
        np.testing.assert_allclose(np.linalg.norm(w, axis=-1), 1, rtol=2e-7)


def test_the_angle_between_light_and_viewer_is_the_same_everywhere(samples):
    cosine = np.einsum("nlk,nk->nl", samples.wi, samples.wo)
    np.testing.assert_allclose(cosine, [[0.64, -0.6]] * len(samples), atol=3e-7)


def test_tangents_run_along_latitude_and_frames_are_right_handed(samples, normal):
    tangent = np.cross([0.0, 1.0, 0.0], normal)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    bitangent = np.cross(normal, tangent)
    light = np.array(LIGHTS[0])
    local = np.stack([tangent @ light, bitangent @ light, normal @ light], axis=-1)
    np.testing.assert_allclose(samples.wi[:, 0], local, atol=2e-7)


@pytest.mark.parametrize("tangents", ["linear", "radial"])
def test_tangents_follow_the_field_that_the_scene_names(tangents, normal):
    samples = trace(lit_sphere(SIZE, LIGHTS, tangents=tangents))
    x, y, z = normal.T
    along = {"linear": [1 + 0 * x, 0 * x, 0 * x], "radial": [x, y, 0 * x]}[tangents]
    along = np.stack(along, axis=-1)
    along[(x == 0) & (y == 0)] = [1, 0, 0]
    tangent = along - normal * np.sum(along * normal, axis=-1, keepdims=True)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    light = np.array(LIGHTS[0])
    local = np.stack([tangent, np.cross(normal, tangent), normal], axis=-2) @ light
    np.testing.assert_allclose(samples.wi[:, 0], local, atol=2e-7)


def test_the_local_frame_at_the_centre_is_that_of_the_world(samples):
    centre = (samples.pixels.row == SIZE // 2) & (samples.pixels.column == SIZE // 2)
    np.testing.assert_allclose(samples.wi[centre], [LIGHTS], atol=1e-7)
    np.testing.assert_allclose(samples.wo[centre], [[0, 0, 1]], atol=1e-7)


def test_weight_is_irradiance_times_cosine_times_exposure(samples, normal):
    cos_i = np.maximum(normal @ np.transpose(LIGHTS), 0)
    expected = 0.5 * cos_i[..., None] * [1.0, 2.0, 3.0]
    np.testing.assert_allclose(samples.weight, expected, rtol=3e-7)
    assert (samples.weight[cos_i == 0] == 0).all()
    assert (cos_i == 0).any()
    assert (samples.cosine == 1).all()


def test_lights_that_give_one_number_take_the_channels_asked_for():
    scene = lit_sphere(4)
    assert trace(scene).weight.shape == (12, 1, 3)
    assert trace(scene, channels=1).weight.shape == (12, 1, 1)
    assert trace(scene).channels == ("R", "G", "B")


def test_channels_that_do_not_agree_are_refused():
    with pytest.raises(ValueError, match="Lights have 2 channels, but 3 are asked for"):
        trace(lit_sphere(4, irradiance=[1.0, 1.0]), channels=3)


def test_tracing_leaves_the_precision_of_jax_alone():
    trace(lit_sphere(4))
    assert jnp.ones(3).dtype == jnp.float32


@pytest.mark.parametrize("light", [Directional([0.6, 0.8, 0.0]), Point([1, 3, 1])])
def test_plain_scenes_are_traced_in_one_program_as_all_others_are_in_steps(light):
    """A sphere on a floor of another material, with its shadow and ambient light."""
    floor = Plane([0, -0.5, 0], [0, 0.8, 0.6], MODELS["lambert"](albedo=[0.5] * 3))
    scene = Scene(Orthographic(24), (Sphere(), floor), (light, Ambient(0.1)))
    brdf = MODELS["ward"]()
    plan = plan_for_tracing(scene, brdf)
    assert plan.on("shadows")
    assert plan.on("ambient")
    assert is_plain(scene, Geometry(scene.shapes), plan)
    steps = radiance(materials_of(scene, brdf), trace_paths(scene, plan, 3))
    image = render(brdf, scene, plan).reshape(-1, 3)
    np.testing.assert_allclose(image, steps, rtol=1e-5, atol=1e-6)


def test_more_directions_than_can_be_kept_are_refused(monkeypatch):
    sky = Environment(np.ones((4, 8, 3), np.float32))
    scene = Scene(Orthographic(8), (Sphere(),), (sky,))
    assert len(trace(scene, plan_for_tracing(scene)))
    monkeypatch.setattr(geometry_pass, "MOST", 100)
    with pytest.raises(
        ValueError, match="52 pixels under 32 directions .* than the 100"
    ):
        trace(scene, plan_for_tracing(scene))
