import numpy as np

import brdffit
from brdffit.plots import coverage_figure
from tests.readers import specimens


def counts(axes):
    return int(np.sum(axes.collections[0].get_array()))


def test_every_usable_sample_is_counted_once_in_each_panel():
    data = specimens.measurement(count=300)
    mask = np.ones(data.f_r.shape, bool)
    mask[:50] = False
    shown = brdffit.Measurement(data.wi, data.wo, data.f_r, mask=mask, name="dust")
    figure = coverage_figure(shown)
    light, viewer, angles, _ = figure.axes
    assert [counts(axes) for axes in (light, viewer, angles)] == [250, 250, 250]
    assert "250 samples" in figure.get_suptitle()


def test_a_direction_stands_where_it_is():
    theta = np.radians(60)
    wi = np.array([[0.0, np.sin(theta), np.cos(theta)]] * 5)
    wo = np.array([[0.0, 0.0, 1.0]] * 5)
    figure = coverage_figure(brdffit.Measurement(wi, wo, np.ones((5, 1))))
    light, viewer, angles, _ = figure.axes
    x, y = light.collections[0].get_offsets()[0]
    size = np.sqrt(2) * np.sin(theta / 2)
    assert (abs(x), abs(y - size)) < (0.03, 0.03)
    assert np.abs(viewer.collections[0].get_offsets()[0]).max() < 0.03
    assert np.abs(angles.collections[0].get_offsets()[0] - 30).max() < 2


def test_lights_that_shine_together_are_all_counted():
    lights = [(0.6, 0, 0.8), (-0.6, 0, 0.8)]
    truth = brdffit.MODELS["lambert"](albedo=[0.5])
    image = brdffit.simulate_image(truth, brdffit.lit_sphere(12, lights))
    lit = int(np.sum(np.asarray(image.wi[..., 2])[image.mask[:, 0]] > 1e-6))
    assert counts(coverage_figure(image).axes[0]) == lit
