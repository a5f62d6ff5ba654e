import dataclasses

import numpy as np
import pytest

import brdffit
from brdffit.survey import reciprocity
from tests.data import shared_data

ANGLES = [10, 30, 50, 70]


@pytest.fixture(scope="module")
def gonio():
    """A model that is not reciprocal, where every pair was measured both ways."""
    truth = brdffit.MODELS["phong_original"](diffuse=[0.0], specular=[0.4], exponent=3)
    instrument = brdffit.Goniometer(ANGLES, ANGLES, [120, 150, 180])
    return brdffit.simulate_measurement(truth, instrument)


def test_a_model_that_is_not_reciprocal_shows_by_how_much(gonio):
    found = reciprocity(gonio)
    cosines = np.cos(np.radians(ANGLES))
    ratio = 1 - cosines[:, None] / cosines
    expected = np.median(ratio[ratio > 0])  # every azimuth has the same ratios
    assert found.isotropic
    assert not found.exact
    assert found.median == pytest.approx(expected, rel=0.02)
    assert found.ninetieth > found.median


def test_masked_values_are_not_compared(gonio):
    wrong = np.array(gonio.f_r)
    wrong[::3] = 1e6
    mask = np.ones(wrong.shape, bool)
    mask[::3] = False
    hidden = dataclasses.replace(gonio, f_r=wrong, mask=mask)
    assert reciprocity(hidden).ninetieth <= reciprocity(gonio).ninetieth + 1e-6


def test_directions_that_are_exchanged_need_no_guess():
    random = np.random.default_rng(0)
    w = random.normal(size=(2, 40, 3))
    w[..., 2] = np.abs(w[..., 2]) + 0.2
    wi, wo = w / np.linalg.norm(w, axis=-1, keepdims=True)
    value = random.uniform(1, 2, (40, 1))
    data = brdffit.Measurement(
        np.vstack([wi, wo]), np.vstack([wo, wi]), np.vstack([value, 1.1 * value])
    )
    found = reciprocity(data)
    assert not found.isotropic
    assert found.pairs == 80
    assert found.median == pytest.approx(0.1 / 1.1)


def test_few_pairs_tell_nothing(gonio):
    alone = dataclasses.replace(
        gonio, wi=gonio.wi[:4], wo=gonio.wo[:4], f_r=gonio.f_r[:4]
    )
    assert reciprocity(alone) is None


def test_what_can_be_evaluated_is_compared_exactly(gonio):
    def evaluate(wi, wo):
        value = np.cos(3 * wi[:, 2]) + wo[:, 2]
        return np.repeat(np.abs(value)[:, None], 1, axis=1)

    there = dataclasses.replace(gonio, f_r=evaluate(gonio.wi, gonio.wo))
    found = reciprocity(there, evaluate)
    back = evaluate(gonio.wo, gonio.wi)
    assert found.exact
    assert found.pairs == np.sum(gonio.wo[:, 2] >= gonio.wi[:, 2].min())
    expected = np.abs(back - there.f_r) / np.maximum(back, there.f_r)
    assert found.median == pytest.approx(np.median(expected), rel=1e-6)


def test_ptfe_is_reciprocal_within_its_noise():
    data = brdffit.load(shared_data("nist_ptfe", "ptfe_regular_532nm.csv"))
    assert reciprocity(data).median < 0.011  # repeat scatter
