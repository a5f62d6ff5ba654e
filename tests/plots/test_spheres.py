import dataclasses

import numpy as np
import pytest
from matplotlib.figure import Figure

import brdffit
from brdffit import MODELS
from brdffit.plots import plot_difference, plot_sphere, spheres_figure
from brdffit.samples import join
from tests.data import shared_data
from tests.results import result_of


def shown(axes):
    """Numbers that the uppermost image in the axes shows."""
    return np.ma.filled(axes.images[-1].get_array().astype(float), np.nan)


def test_measured_stands_beside_fits_with_their_differences(sphere, truth):
    wrong = MODELS["lambert"](albedo=[0.3, 0.2, 0.1])
    fits = {"right": result_of(truth), "wrong": result_of(wrong)}
    figure = spheres_figure(sphere, fits)
    measured, right, wrong, words, no_error, error = figure.axes[:6]
    titles = [axes.get_title() for axes in (measured, right, wrong)]
    assert titles == ["measured", "right", "wrong"]
    np.testing.assert_array_equal(shown(measured), shown(right))
    assert np.nanmax(np.abs(shown(no_error))) < 1e-6
    assert np.nanmin(shown(error)) < -0.1  # the highlight is missing
    assert "fitted - measured" in words.texts[0].get_text()


def test_differences_are_white_at_zero_and_share_their_scale(sphere, truth):
    fits = {"a": result_of(truth), "b": result_of(MODELS["lambert"]())}
    figure = spheres_figure(sphere, fits)
    limits = [axes.images[-1].get_clim() for axes in figure.axes[4:6]]
    assert limits[0] == limits[1]
    assert limits[0][0] == -limits[0][1]
    white = figure.axes[5].images[-1].cmap(0.5)
    assert min(white) > 0.96


def test_unused_pixels_are_grey_and_the_words_say_so(sphere, truth):
    mask = np.array(sphere.mask)
    mask[:100] = False
    masked = dataclasses.replace(sphere, mask=mask)
    figure = spheres_figure(masked, {"fit": result_of(truth)})
    below = figure.axes[3]
    grey = below.images[0].get_array()[..., 3] > 0
    assert grey.sum() == (~mask).any(axis=1).sum()
    assert "grey: not used" in figure.axes[2].texts[0].get_text()


def test_of_many_photographs_the_first_and_the_last_are_shown(truth):
    lights = [(0.6, 0, 0.8), (0, 0.6, 0.8), (-0.6, 0, 0.8)]
    frames = join(
        [brdffit.simulate_image(truth, brdffit.lit_sphere(16, [d])) for d in lights]
    )
    figure = spheres_figure(frames, {"fit": result_of(truth)})
    titles = [axes.get_title() for axes in figure.axes]
    assert [t for t in titles if "measured" in t] == [
        "measured, light 1",
        "measured, light 3",
    ]


def test_a_goniometer_shows_spheres_rendered_with_the_fits(goniometer, truth):
    fits = {f"model {i}": result_of(truth) for i in range(5)}
    figure = spheres_figure(goniometer, fits)
    assert [axes.get_title() for axes in figure.axes] == [
        f"model {i}" for i in range(4)
    ]
    assert "rendered" in figure.get_suptitle()
    assert "the best 4 of 5 models" in figure.get_suptitle()
    assert "exposure" in figure.get_supxlabel()


def test_pixels_without_a_sample_stay_empty():
    axes = Figure().subplots()
    image = np.full((4, 4, 3), np.nan)
    image[1, 2] = 0.5
    plot_sphere(axes, image)
    alpha = axes.images[0].get_array()[..., 3]
    assert alpha[1, 2] == 255
    assert alpha.sum() == 255


def test_a_difference_shows_the_mean_of_its_channels():
    axes = Figure().subplots()
    picture = plot_difference(axes, np.array([[[0.0, 0.3, 0.6]]]), limit=1.0)
    assert picture.get_array()[0, 0] == pytest.approx(0.3)


def test_photographs_of_a_ball_show_a_ball():
    data = brdffit.load(shared_data("sphere_photos", "diligent_ball"))
    fit = MODELS["lambert"](albedo=[0.158, 0.134, 0.087])
    figure = spheres_figure(data, {"lambert": result_of(fit)})
    photograph = shown(figure.axes[0])
    rows, columns = photograph.shape[:2]
    assert abs(rows - columns) <= 4
    inside = photograph[rows // 2, columns // 2]
    corner = photograph[0, 0]
    assert inside[:3].min() > 80
    assert corner[3] == 0
