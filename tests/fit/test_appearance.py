import dataclasses

import numpy as np
import pytest

import brdffit
from brdffit import MODELS
from brdffit.fit.appearance import colour_difference, sphere_difference

GREY = np.linspace(0.05, 1, 50)[:, None] * np.ones(3)


def test_what_is_the_same_is_not_apart():
    same = colour_difference(GREY, GREY)
    assert (same.ciede2000, same.itp) == pytest.approx((0, 0), abs=1e-9)


def test_scale_does_not_matter_and_grey_is_neutral():
    found, wanted = GREY * [1.0, 0.9, 0.8], GREY
    once, thrice = (
        colour_difference(found * scale, wanted * scale) for scale in (1, 3)
    )
    assert dataclasses.astuple(once) == pytest.approx(dataclasses.astuple(thrice))
    thin = colour_difference(0.9 * GREY[:, :1], GREY[:, :1])
    assert dataclasses.astuple(thin) == pytest.approx(
        dataclasses.astuple(colour_difference(0.9 * GREY, GREY)), rel=0.01
    )


def test_a_small_step_of_grey_has_the_published_size():
    """By its formula for lightness alone, between CIELAB 50 and 51."""
    light = ((np.array([50.0, 51.0]) + 16) / 116) ** 3
    white = np.ones((1, 1))
    pixels = [np.array([[y]]) for y in light]
    found, wanted = (np.vstack([p, white]) for p in pixels)
    scale = 1 + 0.015 * 0.25 / np.sqrt(20.25)
    # two pixels, of which the white one is the same; percentile 99 of two is below 1
    expected = 1 / scale / 2
    assert colour_difference(found, wanted).ciede2000 == pytest.approx(
        expected, rel=0.02
    )


def test_a_threshold_of_itp_is_about_one():
    step = colour_difference(GREY * 1.005, GREY)
    assert 0.1 < step.itp < 1.5


def test_pixels_of_other_channels_are_refused():
    with pytest.raises(ValueError, match="one channel or three"):
        colour_difference(np.ones((5, 4)), np.ones((5, 4)))


def test_a_sphere_is_compared_with_its_photograph():
    truth = MODELS["lambert"](albedo=[0.6, 0.4, 0.2])
    image = brdffit.simulate_image(truth, brdffit.lit_sphere(24))
    assert sphere_difference(truth, image).ciede2000 < 1e-4
    redder = MODELS["lambert"](albedo=[0.8, 0.4, 0.2])
    assert sphere_difference(redder, image).ciede2000 > 3


def test_single_directions_are_compared_by_a_sphere_of_the_reference():
    truth = MODELS["lambert"](albedo=[0.5])
    data = brdffit.simulate_measurement(truth, brdffit.Goniometer([30], [0, 30], [0]))
    assert sphere_difference(truth, data) is None
    assert sphere_difference(truth, data, truth).itp < 1e-4
    darker = MODELS["lambert"](albedo=[0.25])
    assert sphere_difference(darker, data, truth).ciede2000 > 10


def test_wavelengths_are_no_colours():
    truth = MODELS["lambert"](albedo=[0.5, 0.4, 0.3])
    data = brdffit.simulate_measurement(truth, brdffit.Goniometer([30], [0, 30], [0]))
    spectral = dataclasses.replace(data, channels=("450 nm", "550 nm", "650 nm"))
    assert sphere_difference(truth, spectral, truth) is None
