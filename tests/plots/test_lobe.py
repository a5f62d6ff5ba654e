import numpy as np
import pytest
from matplotlib.figure import Figure

import brdffit
from brdffit import MODELS
from brdffit.plots import lobe_figure, planes, plot_lobe
from brdffit.samples import pick_channels
from tests.results import result_of


def results(*brdfs):
    return {f"model {i}": result_of(brdf) for i, brdf in enumerate(brdfs)}


def test_figure_says_what_is_seen_in_words_and_units(goniometer, truth):
    figure = lobe_figure(goniometer, results(truth))
    assert figure.get_suptitle() == "phong: measured and fitted lobes, channel G"
    above, below = figure.axes[:2], figure.axes[2:]
    assert ["20" in above[0].get_title(), "50" in above[1].get_title()] == [True, True]
    assert all("degrees" in axes.get_xlabel() for axes in below)
    assert above[0].get_ylabel() == "$f_r$ [1/sr]"
    assert below[0].get_ylabel() == "$f_r$ [1/sr], log scale"
    (legend,) = figure.legends
    assert [t.get_text() for t in legend.get_texts()] == ["measured", "model 0"]


def test_linear_above_and_logarithmic_below_with_equal_limits(goniometer, truth):
    figure = lobe_figure(goniometer, results(truth))
    assert [axes.get_yscale() for axes in figure.axes] == ["linear"] * 2 + ["log"] * 2
    assert figure.axes[2].get_ylim() == figure.axes[3].get_ylim()


def test_channel_is_chosen_by_name(goniometer, truth):
    red = lobe_figure(goniometer, results(truth), channel="R").axes[0].lines[0]
    blue = lobe_figure(goniometer, results(truth), channel="B").axes[0].lines[0]
    assert red.get_ydata().max() > blue.get_ydata().max()
    with pytest.raises(ValueError, match="Channel `X` must be one of R, G, B"):
        lobe_figure(goniometer, results(truth), channel="X")


def test_only_the_best_five_are_drawn_and_the_title_says_so(goniometer, truth):
    figure = lobe_figure(goniometer, results(*[truth] * 6))
    assert len(figure.legends[0].get_texts()) == 1 + 5
    assert "the best 5 of 6 models" in figure.get_suptitle()


def test_coinciding_curves_differ_in_colour_dash_and_width(goniometer, truth):
    figure = lobe_figure(goniometer, results(truth, truth, truth))
    curves = figure.axes[0].lines[1:4]
    for look in ("get_color", "get_linewidth", "get_linestyle", "get_zorder"):
        values = {str(getattr(curve, look)()) for curve in curves}
        assert len(values) == 3 or look == "get_linestyle", look
    # the best lies on top and is the thinnest
    assert curves[0].get_zorder() > curves[2].get_zorder()
    assert curves[0].get_linewidth() < curves[2].get_linewidth()


def test_panel_is_drawn_into_given_axes(goniometer, truth):
    axes = Figure().subplots()
    plane = planes(goniometer)[1]
    plot_lobe(axes, plane, {"truth": truth})
    marks, curve = axes.lines[:2]
    assert len(marks.get_xdata()) == len(plane.angle)
    at = np.interp(50, curve.get_xdata(), np.nan_to_num(curve.get_ydata()))
    assert at == pytest.approx(plane.f_r[plane.angle.searchsorted(49.9), 0], rel=1e-3)


def test_a_sphere_is_drawn_by_the_angle_of_the_half_vector(sphere, truth):
    (above, below) = lobe_figure(sphere, results(truth)).axes
    assert "50" in above.get_title()
    assert "theta_h" in below.get_xlabel()


def test_a_single_channel_is_not_named(goniometer):
    grey = pick_channels(goniometer, ["B"])
    figure = lobe_figure(grey, results(MODELS["lambert"](albedo=[0.1])))
    assert figure.get_suptitle() == "phong: measured and fitted lobes"


def test_data_without_a_plane_are_refused_in_a_sentence(truth):
    lights = brdffit.lit_sphere(16, ((0, 0, 1), (0.6, 0, 0.8)))
    with pytest.raises(ValueError, match="must have samples in a plane of incidence"):
        lobe_figure(brdffit.simulate_image(truth, lights), results(truth))
