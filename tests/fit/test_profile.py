"""Intervals that do not take the cost for a parabola."""

import numpy as np
import pytest

import brdffit
from brdffit import MODELS, Goniometer, Noise, simulate_measurement
from brdffit.plots import profile_figure
from brdffit.samples import Measurement

GRID = Goniometer(theta_i=[10, 40, 65], theta_o=np.linspace(2, 80, 7), phi=[0, 90, 180])


@pytest.fixture(scope="module")
def measurement():
    truth = MODELS["oren_nayar"](albedo=np.array([0.5], np.float32), sigma=0.4)
    made = simulate_measurement(truth, GRID, Noise(relative=0.02, seed=3))
    return Measurement(wi=made.wi, wo=made.wo, f_r=made.f_r, name="plaster")


OPTIONS = {"residual": "log", "starts": 1}


def test_the_profile_of_a_well_determined_parameter_is_its_parabola(measurement):
    found = brdffit.profile("oren_nayar", measurement, "sigma", points=9, **OPTIONS)
    best = found.result.parameters["sigma"]
    error = found.result.standard_errors["sigma"]
    parabola = ((found.values - best) / error) ** 2
    near = np.abs(found.values - best) < 2.5 * error
    np.testing.assert_allclose(found.rise[near], parabola[near], rtol=0.1, atol=0.02)
    half = np.diff(found.interval)[0] / 2
    assert half == pytest.approx(1.96 * error, rel=0.05)
    figure = profile_figure(found)
    assert "sigma lies between" in figure.get_suptitle()


def test_resamples_scatter_as_much_as_the_standard_errors_say(measurement):
    found = brdffit.bootstrap(
        "oren_nayar", measurement, resamples=60, seed=1, **OPTIONS
    )
    assert found.parameters["albedo"].shape == (60, 1)
    for name, error in found.result.standard_errors.items():
        # the scatter of 60 values is itself known to 9 %
        np.testing.assert_allclose(found.standard_errors[name], error, rtol=0.3)
        low, high = found.intervals[name]
        assert np.all(low < found.result.parameters[name])
        assert np.all(found.result.parameters[name] < high)


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("albedo", {}, "must be free and have one value in all channels"),
        ("sigma", {"fixed": {"sigma": 0.3}}, "must be free"),
        ("sgma", {}, "Did you mean `sigma`?"),
        ("sigma", {"loss": "huber"}, "without `loss`"),
    ],
)
def test_what_has_no_profile_is_refused(measurement, name, options, sentence):
    with pytest.raises(ValueError, match=sentence):
        brdffit.profile("oren_nayar", measurement, name, **OPTIONS, **options)


def test_one_resample_is_too_few(measurement):
    with pytest.raises(ValueError, match="2 or above"):
        brdffit.bootstrap("oren_nayar", measurement, resamples=1)
