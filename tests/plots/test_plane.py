import dataclasses

import numpy as np
import pytest

import brdffit
from brdffit import MODELS
from brdffit.plots.lobe import predicted
from brdffit.plots.plane import direction, planes, polar
from tests.data import shared_data

GLOSS = MODELS["ggx"](diffuse=[0.2], f0=[0.1], alpha=0.1)
ANGLES = np.arange(0, 81, 5)


@pytest.fixture(scope="module")
def goniometer():
    instrument = brdffit.Goniometer([0, 30, 60], ANGLES, [0, 60, 120, 180])
    return brdffit.simulate_measurement(GLOSS, instrument)


def assert_drawn_through_its_samples(plane, brdf, tolerance):
    drawn = predicted(brdf, plane)[:, 0]
    at = np.interp(plane.angle, plane.curve, np.nan_to_num(drawn))
    np.testing.assert_allclose(at, plane.f_r[:, 0], rtol=tolerance)


def test_a_goniometer_is_cut_at_each_angle_of_incidence(goniometer):
    found = planes(goniometer)
    assert [round(plane.mirror) for plane in found] == [0, 30, 60]
    for angle, plane in zip((0, 30, 60), found, strict=True):
        assert f"= {angle}" in plane.title


def test_only_samples_in_the_plane_of_incidence_are_taken(goniometer):
    plane = planes(goniometer)[1]
    # both sides, with the normal once for each of the four azimuths
    assert len(plane.angle) == 2 * (len(ANGLES) - 1) + 4
    assert plane.angle.min() == pytest.approx(-80)
    assert plane.angle.max() == pytest.approx(80)


def test_models_are_drawn_through_their_own_samples(goniometer):
    for plane in planes(goniometer):
        assert_drawn_through_its_samples(plane, GLOSS, tolerance=0.01)


def test_the_lobe_stands_on_the_positive_side():
    angles = np.arange(0, 81, 5)
    instrument = brdffit.Goniometer([30], angles, [0, 180])
    plane = planes(brdffit.simulate_measurement(GLOSS, instrument))[0]
    assert plane.angle[plane.f_r[:, 0].argmax()] == pytest.approx(30)


def test_a_plane_at_any_azimuth_is_found(goniometer):
    turn = np.radians(35)
    rotation = np.array(
        [[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]],
        np.float32,
    )
    turned = dataclasses.replace(
        goniometer, wi=goniometer.wi @ rotation, wo=goniometer.wo @ rotation
    )
    for plain, other in zip(planes(goniometer), planes(turned), strict=True):
        np.testing.assert_allclose(other.angle, plain.angle, atol=1e-3)
        assert_drawn_through_its_samples(other, GLOSS, tolerance=0.01)


def test_masked_samples_are_left_out(goniometer):
    keep = np.ones(goniometer.f_r.shape, bool)
    keep[goniometer.wo[:, 0] > 0.5] = False
    plane = planes(dataclasses.replace(goniometer, mask=keep))[1]
    assert plane.angle.min() > -31


def test_a_value_masked_in_one_channel_leaves_the_others(goniometer):
    wide = dataclasses.replace(goniometer, f_r=np.repeat(goniometer.f_r, 2, axis=1))
    mask = np.ones(wide.f_r.shape, bool)
    mask[:, 1] = False
    plane = planes(dataclasses.replace(wide, mask=mask, channels=("a", "b")))[1]
    assert np.isfinite(plane.f_r[:, 0]).all()
    assert np.isnan(plane.f_r[:, 1]).all()


def test_azimuth_is_told_only_where_it_differs():
    both = brdffit.Goniometer([0, 30], ANGLES, [0, 180])
    data = brdffit.simulate_measurement(GLOSS, both)
    assert not any("phi" in plane.title for plane in planes(data))
    turned = dataclasses.replace(data, wi=data.wi * np.float32([-1, -1, 1]))
    joined = {
        name: np.concatenate([getattr(data, name), getattr(turned, name)])
        for name in ("wi", "wo", "f_r")
    }
    found = planes(dataclasses.replace(data, **joined))
    assert [r"\phi_i = 180" in plane.title for plane in found] == [False, False, True]


@pytest.mark.parametrize(("count", "width"), [(5000, 5), (100000, 2), (400000, 1)])
def test_scattered_directions_are_gathered_as_near_as_leaves_enough(count, width):
    wi, wo = np.random.default_rng(0).standard_normal((2, count, 3))
    wi, wo = (w / np.linalg.norm(w, axis=1, keepdims=True) for w in (wi, wo))
    wi[:, 2], wo[:, 2] = np.abs(wi[:, 2]), np.abs(wo[:, 2])
    found = planes(brdffit.Measurement(wi=wi, wo=wo, f_r=np.ones((count, 1))))
    assert len(found) == 5
    assert all(rf"\pm {width}" in plane.title for plane in found)


def test_a_sphere_is_cut_through_light_and_viewer():
    scene = brdffit.lit_sphere(96)
    (plane,) = planes(brdffit.simulate_image(GLOSS, scene))
    assert "50" in plane.title  # arccos of 0.64, the z of the light
    assert abs(plane.angle[plane.f_r[:, 0].argmax()]) < 2
    assert_drawn_through_its_samples(plane, GLOSS, tolerance=1e-5)
    # the light is nearer to the horizon of the viewer's side
    assert plane.angle.max() == pytest.approx(90 - 25, abs=3)


def test_several_lights_at_once_leave_no_plane():
    scene = brdffit.lit_sphere(32, ((0, 0, 1), (0.6, 0, 0.8)))
    assert planes(brdffit.simulate_image(GLOSS, scene)) == []


def test_a_light_behind_the_viewer_makes_no_plane():
    scene = brdffit.lit_sphere(32, ((0, 0, 1),))
    assert planes(brdffit.simulate_image(GLOSS, scene)) == []


def test_fred_files_show_their_four_angles_of_incidence():
    data = brdffit.load(shared_data("ualoft", "AnoBlackEC1onAlum.txt"))
    assert [round(plane.mirror) for plane in planes(data)] == [10, 30, 50, 70]


def test_polar_angles_undo_directions():
    theta, phi = polar(direction(np.array([10.0, 80.0]), 30.0))
    np.testing.assert_allclose(theta, [10, 80])
    np.testing.assert_allclose(phi, [30, 30])
