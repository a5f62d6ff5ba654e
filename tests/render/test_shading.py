import importlib

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import brdffit
from brdffit.models import MODELS
from brdffit.render import render, shade, trace
from brdffit.scene import lit_sphere

LIGHTS = ((-0.48, 0.6, 0.64), (0.8, 0.0, 0.6), (0.0, -0.8, 0.6))
LAMBERT = MODELS["lambert"](albedo=[0.8, 0.4, 0.2])
GGX = MODELS["ggx"](diffuse=[0.35, 0.15, 0.08], f0=[0.12, 0.1, 0.06], alpha=0.3)


def test_a_diffuse_sphere_is_albedo_times_cosine_over_pi():
    size = 20
    image = render(LAMBERT, lit_sphere(size, LIGHTS[:1], [1.0, 2.0, 3.0], 0.5))
    x = (2 * np.arange(size) + 1) / size - 1
    x, y = np.meshgrid(x, -x)
    inside = x * x + y * y < 1
    z = np.sqrt(np.where(inside, 1 - x * x - y * y, 0))
    cos_i = np.maximum(-0.48 * x + 0.6 * y + 0.64 * z, 0) * inside
    expected = cos_i[..., None] * np.multiply([0.8, 0.4, 0.2], [1, 2, 3]) * 0.5 / np.pi
    assert image.dtype == np.float32
    np.testing.assert_allclose(image, expected, rtol=1e-6)


def test_a_white_diffuse_surface_that_faces_the_default_light_has_the_value_1():
    image = render(MODELS["lambert"](albedo=1.0), lit_sphere(101))
    assert image.max() == pytest.approx(1, abs=1e-3)


def test_lights_add_up():
    together = render(GGX, lit_sphere(24, LIGHTS))
    one_by_one = [render(GGX, lit_sphere(24, [light])) for light in LIGHTS]
    np.testing.assert_allclose(together, np.sum(one_by_one, axis=0), rtol=1e-5)


@pytest.mark.parametrize("count", [1, 4])
def test_an_image_has_the_channels_of_the_brdf(count):
    brdf = MODELS["lambert"](albedo=[0.5] * count)
    assert render(brdf, lit_sphere(8)).shape == (8, 8, count)


def test_lights_with_other_channels_than_the_brdf_are_refused():
    with pytest.raises(ValueError, match="Lights have 2 channels, but 3 are asked for"):
        render(LAMBERT, lit_sphere(8, irradiance=[1.0, 1.0]))


def test_shading_has_finite_derivatives_in_every_parameter():
    samples = trace(lit_sphere(16, LIGHTS))
    jacobian = eqx.filter_jit(jax.jacfwd(lambda brdf: shade(brdf, samples)))(GGX)
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(jacobian))
    received = np.sum(samples.weight[..., 0], axis=1) / np.pi
    np.testing.assert_allclose(jacobian.diffuse[:, 0, 0], received, rtol=1e-5)
    np.testing.assert_array_equal(jacobian.diffuse[:, 0, 1], 0)
    assert jnp.abs(jacobian.alpha).max() > 0


def test_the_public_function_is_not_hidden_by_the_folder_of_its_name():
    importlib.import_module("brdffit.render.shading")
    assert brdffit.render is render
