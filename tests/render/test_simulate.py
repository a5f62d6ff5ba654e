import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.models import MODELS
from brdffit.render import (
    Noise,
    description,
    provenance,
    render,
    simulate_image,
    simulate_measurement,
)
from brdffit.scene import Goniometer, lit_sphere

GGX = MODELS["ggx"](diffuse=[0.35, 0.15, 0.08], f0=[0.12, 0.1, 0.06], alpha=0.3)
SCENE = lit_sphere(48)
GONIOMETER = Goniometer([0, 30, 60], range(0, 90, 5), [0, 90, 180])


@pytest.fixture(scope="module")
def clean():
    return simulate_image(GGX, SCENE)


def test_an_image_without_noise_is_the_render(clean):
    image = clean.pixels.images(clean.value, background=0.0)[0]
    np.testing.assert_allclose(image, render(GGX, SCENE), rtol=2e-5)
    assert clean.sigma is None
    assert clean.name == "ggx"


def test_what_no_light_reaches_is_masked(clean):
    np.testing.assert_array_equal(clean.mask, clean.weight[:, 0] > 0)
    assert not clean.mask.all()


def test_noise_has_the_standard_deviation_that_is_recorded(clean):
    noisy = simulate_image(GGX, SCENE, Noise(relative=0.05, additive=0.01, seed=3))
    expected = np.hypot(0.05 * clean.value, 0.01)
    np.testing.assert_allclose(noisy.sigma, expected, rtol=1e-6)
    pull = ((noisy.value - clean.value) / noisy.sigma).ravel()
    # mean and mean square of n normal numbers, each within four standard deviations
    assert abs(pull.mean()) < 4 / pull.size**0.5
    assert abs((pull**2).mean() - 1) < 4 * (2 / pull.size) ** 0.5
    channels = np.corrcoef((noisy.value - clean.value).T)
    assert np.abs(channels - np.eye(3)).max() < 4 / len(clean) ** 0.5


def test_the_seed_decides_the_noise():
    first, again, other = (
        simulate_image(GGX, SCENE, Noise(relative=0.05, seed=seed)).value
        for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()


def test_values_that_relative_noise_leaves_certain_are_masked():
    brdf = MODELS["phong"](diffuse=0.0, specular=0.5, exponent=5.0)
    noisy = simulate_measurement(brdf, GONIOMETER, Noise(relative=0.02))
    np.testing.assert_array_equal(noisy.mask, noisy.f_r > 0)
    assert not noisy.mask.all()


def test_lit_pixels_of_certain_zero_are_masked_in_images_too():
    brdf = MODELS["phong"](diffuse=0.0, specular=0.5, exponent=5.0)
    noisy = simulate_image(brdf, SCENE, Noise(relative=0.02))
    np.testing.assert_array_equal(noisy.mask, noisy.value > 0)
    assert (noisy.mask != (noisy.weight[:, 0] > 0)).any()


def test_additive_noise_keeps_negative_values():
    noisy = simulate_measurement(GGX, GONIOMETER, Noise(additive=1.0))
    assert (noisy.f_r < 0).any()
    assert noisy.mask.all()


def test_a_measurement_is_the_brdf_at_the_angles_of_the_goniometer():
    measurement = simulate_measurement(GGX, GONIOMETER)
    wi, wo = GONIOMETER.directions()
    np.testing.assert_array_equal(measurement.wi, wi)
    np.testing.assert_array_equal(measurement.wo, wo)
    for row in (0, 50, 160):
        np.testing.assert_allclose(
            measurement.f_r[row], GGX(*map(jnp.asarray, (wi[row], wo[row]))), 1e-6
        )
    assert measurement.channels == ("R", "G", "B")
    assert measurement.sigma is None
    assert measurement.mask is None


def test_provenance_tells_the_truth_in_short_numbers():
    assert provenance(GGX, Noise(0.02, 0.0, 7)) == {
        "model": "ggx",
        "parameters": {
            "diffuse": [0.35, 0.15, 0.08],
            "f0": [0.12, 0.1, 0.06],
            "alpha": 0.3,
        },
        "noise": {"relative": 0.02, "additive": 0.0, "seed": 7},
    }


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"relative": -0.1}, "`relative` must be one number not below 0"),
        ({"additive": float("nan")}, "`additive` must consist of finite numbers"),
        ({"seed": 1.5}, "`seed` must be a whole number, 0 or above"),
    ],
)
def test_wrong_noise_is_named(wrong, sentence):
    with pytest.raises(ValueError, match=sentence):
        Noise(**wrong)


def test_the_parts_of_a_sum_and_unusual_options_are_described():
    lobe = MODELS["ggx_lobe"](f0=[0.04] * 3, alpha=0.1, separable=True)
    told = description(MODELS["lambert"](albedo=[0.1, 0.2, 0.3]) + lobe)
    assert told == {
        "model": "sum",
        "first": {"model": "lambert", "parameters": {"albedo": [0.1, 0.2, 0.3]}},
        "second": {
            "model": "ggx_lobe",
            "parameters": {"f0": [0.04] * 3, "alpha": 0.1},
            "separable": True,
        },
    }
