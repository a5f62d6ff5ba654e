import dataclasses
import json

import numpy as np
import pytest

import brdffit
from brdffit.fit.select import split
from brdffit.models import MODELS
from tests.data import shared_data

MODELS_COMPARED = ["lambert", "phong", "ggx"]


@pytest.fixture(scope="module")
def measurement():
    grid = brdffit.Goniometer(
        theta_i=[0.0, 20.0, 45.0, 70.0],
        theta_o=[float(theta) for theta in range(0, 81, 5)],
        phi=[0.0, 45.0, 90.0, 135.0, 180.0],
    )
    truth = MODELS["ggx"](diffuse=[0.4], f0=[0.1], alpha=0.2)
    return brdffit.simulate_measurement(
        truth, grid, brdffit.Noise(relative=0.02, seed=3)
    )


def test_the_model_that_made_the_data_wins(measurement, tmp_path):
    begun = []
    comparison = brdffit.compare(measurement, MODELS_COMPARED, on_model=begun.append)
    assert begun == MODELS_COMPARED
    assert comparison.best.model == "ggx"
    assert list(comparison.results)[-1] == "lambert"
    held_out = [entry.held_out for entry in comparison.entries]
    assert held_out == sorted(held_out)
    assert [entry.tied for entry in comparison.entries] == [True, False, False]
    # held-out error of the truth is the noise itself
    assert held_out[0] == pytest.approx(0.02, rel=0.2)
    criteria = [entry.result.aicc for entry in comparison.entries]
    assert criteria == sorted(criteria)
    comparison.save(tmp_path / "comparison.json")
    ranking = json.loads((tmp_path / "comparison.json").read_text())["ranking"]
    assert [row["model"] for row in ranking] == list(comparison.results)


def test_two_models_that_say_the_same_are_tied(measurement):
    """A lobe without a base cannot beat the same lobe with one, but GGX ties itself."""
    comparison = brdffit.compare(
        measurement, ["ggx", MODELS["ggx"](diffuse=[0.3], f0=[0.2], alpha=0.4)]
    )
    assert all(entry.tied for entry in comparison.entries)


def test_the_split_is_that_of_the_seed(measurement):
    first, again, other = (
        brdffit.compare(measurement, ["lambert"], seed=seed).entries[0].held_out
        for seed in (0, 0, 1)
    )
    assert first == again != other


def test_held_out_directions_are_never_seen(measurement):
    """Under the log residual Lambert is the geometric mean of what it saw."""
    measurement = dataclasses.replace(measurement, sigma=None)
    log = np.log(np.asarray(measurement.f_r[:, 0], float))
    seen, unseen = split(np.arange(len(log)), 0)
    entry = brdffit.compare(measurement, ["lambert"], residual="log").entries[0]
    expected = np.sqrt(np.mean((log[unseen] - log[seen].mean()) ** 2))
    assert entry.held_out == pytest.approx(expected, rel=1e-5)
    assert not set(seen) & set(unseen)


def test_four_directions_are_too_few():
    w = np.array([[0.0, 0.0, 1.0]] * 4)
    data = brdffit.Measurement(wi=w, wo=w, f_r=np.ones((4, 1)))
    with pytest.raises(ValueError, match="at least 5 usable directions"):
        brdffit.compare(data, ["lambert"])


@pytest.mark.parametrize(
    ("name", "ggx", "lambert"),
    [("AnoBlackEC1onAlum", 0.118, 0.75), ("AnoBlackNiTEonINVAR", 0.30, 1.24)],
)
def test_black_coatings_are_explained_by_a_microfacet_lobe(name, ggx, lambert):
    """Log-RMS over all rows of the two goniometer files."""
    measurement = brdffit.load(shared_data("ualoft", f"{name}.txt"))
    models = ["lambert", "oren_nayar", "phong", "ggx"]
    comparison = brdffit.compare(measurement, models)
    assert comparison.residual == "log"
    rms = {m: r.rms["log"] for m, r in comparison.results.items()}
    assert rms["ggx"] < ggx
    assert rms["lambert"] == pytest.approx(lambert, abs=0.005)
    assert list(comparison.results)[:2] == ["ggx", "phong"]


def test_directions_weigh_as_their_solid_angle(measurement):
    """One wild direction that stands for nothing moves neither error nor ranking."""
    wild = np.array(measurement.f_r)
    wild[::10] *= 30
    area = np.ones(len(wild))
    area[::10] = 1e-9
    spoiled = dataclasses.replace(
        measurement, f_r=wild, solid_angle=area, sigma=None, mask=None
    )
    result = brdffit.fit("lambert", spoiled, residual="log", starts=1)
    kept = np.arange(len(wild)) % 10 > 0
    errors = np.log(np.asarray(result.parameters["albedo"]) / np.pi / wild[kept])
    assert result.rms["log"] == pytest.approx(np.sqrt(np.mean(errors**2)), rel=1e-4)
    comparison = brdffit.compare(spoiled, ["lambert"], residual="log", starts=1)
    assert comparison.entries[0].held_out == pytest.approx(result.rms["log"], rel=0.5)
