import dataclasses

import numpy as np
import pytest
from matplotlib.figure import Figure

import brdffit
from brdffit import MODELS
from brdffit.fit import RESIDUALS
from brdffit.fit.misfit import misfit
from brdffit.plots import plot_residuals, residuals_figure
from brdffit.plots.residuals import sample_angles
from brdffit.samples import as_samples
from tests.results import result_of


@pytest.mark.parametrize("name", RESIDUALS)
def test_the_truth_has_no_residual(name, goniometer, truth):
    error = misfit(truth, as_samples(goniometer), RESIDUALS[name])
    assert np.nanmax(np.abs(error)) < 1e-5


def test_a_model_that_is_twice_as_bright_is_off_by_ln_2(goniometer):
    lambert = MODELS["lambert"](albedo=[0.2, 0.2, 0.2])
    data = dataclasses.replace(
        goniometer, f_r=np.full_like(goniometer.f_r, 0.1 / np.pi)
    )
    error = misfit(lambert, as_samples(data), RESIDUALS["log"])
    np.testing.assert_allclose(error, np.log(2), rtol=1e-5)


def test_values_that_a_fit_does_not_use_have_no_residual(goniometer, truth):
    mask = np.ones(goniometer.f_r.shape, bool)
    mask[3, 1] = False
    masked = as_samples(dataclasses.replace(goniometer, mask=mask))
    error = misfit(truth, masked, RESIDUALS["plain"])
    np.testing.assert_array_equal(np.isnan(error), ~mask)


def test_angles_are_those_of_the_light_that_can_add_most():
    scene = brdffit.lit_sphere(8, ((0, 0, 1), (0.6, 0, 0.8)))
    samples = brdffit.simulate_image(MODELS["lambert"](), scene)
    weight = np.array(samples.weight)
    weight[:, 0] = 0.0
    angles = sample_angles(dataclasses.replace(samples, weight=weight))
    theta_i = next(iter(angles.values()))
    expected = np.degrees(np.arccos(np.clip(samples.wi[:, 1, 2], -1, 1)))
    lit = weight.any(axis=(1, 2))
    np.testing.assert_allclose(theta_i[lit], expected[lit], atol=0.05)
    assert sum("brightest light" in label for label in angles) == 2


def test_figure_has_a_row_for_each_fit_and_a_column_for_each_angle(goniometer, truth):
    fits = {"right": result_of(truth), "wrong": result_of(MODELS["lambert"]())}
    figure = residuals_figure(goniometer, fits)
    grid = np.array(figure.axes).reshape(2, 3)
    assert [axes.get_ylabel() for axes in grid[:, 0]] == ["right", "wrong"]
    below = [axes.get_xlabel() for axes in grid[1]]
    assert [label[:9] for label in below] == [rf"$\theta_{name}" for name in "ioh"]
    assert figure.get_supylabel() == r"fitted - measured $\ln f_r$"
    low, high = grid[0, 0].get_ylim()
    assert low == -high
    assert grid[1, 2].get_ylim() == (low, high)


def test_median_and_band_follow_the_errors():
    axes = Figure().subplots()
    angle = np.linspace(0, 90, 5000)
    noise = np.random.default_rng(0).standard_normal((5000, 1))
    plot_residuals(axes, angle, 0.5 + 0.1 * noise, limit=1.0)
    median = axes.lines[1].get_ydata()
    np.testing.assert_allclose(median, 0.5, atol=0.03)
    band = axes.collections[0].get_paths()[0].vertices[:, 1]
    assert band.min() == pytest.approx(0.4, abs=0.04)
    assert band.max() == pytest.approx(0.6, abs=0.04)


def test_figure_says_how_much_lies_beyond_its_axis(goniometer, truth):
    spiked = np.array(goniometer.f_r)
    spiked[0] *= 1000
    data = dataclasses.replace(goniometer, f_r=spiked)
    figure = residuals_figure(data, {"fit": result_of(truth)})
    error = misfit(truth, as_samples(data), RESIDUALS["log"])
    share = np.mean(np.abs(error) > figure.axes[0].get_ylim()[1])
    assert share > 0
    assert f"{share:.2%} of the values" in figure.axes[2].get_title(loc="right")
