"""Experiments on measured materials, each in a reduced version."""

import csv
import tomllib

import jax
import numpy as np
import pytest

import brdffit
from brdffit.batch.surface import open_surface
from brdffit.samples import Measurement
from experiments import (
    ball_gloss,
    ball_texture,
    curet_matte,
    merl_ranking,
    merl_standins,
    ptfe,
)
from tests.data import shared_data


@pytest.fixture(autouse=True)
def as_a_script(monkeypatch):
    """Only the package must spell out every broadcast; no program is kept."""
    monkeypatch.setenv("BRDFFIT_CACHE", "off")
    with jax.numpy_rank_promotion("allow"):
        yield


def table(folder, name="table"):
    assert "seconds" in tomllib.loads((folder / "run.toml").read_text())
    assert (folder / "figure.png").stat().st_size > 1000
    with open(folder / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_merl_stand_ins_are_read_back_whole_and_fitted(tmp_path, monkeypatch):
    shared_data("merl_standins")
    monkeypatch.setattr(merl_ranking, "RESIDUALS", ("log",))
    models = ("lambert", "blinn_phong")
    merl_ranking.main(tmp_path, count=1, models=models, samples=400)
    rows = table(tmp_path, "fits")
    assert [row["identical"] for row in rows] == ["True"] * 2
    errors = {(row["residual"], row["model"]): float(row["rms"]) for row in rows}
    assert errors["log", "blinn_phong"] < errors["log", "lambert"]
    best = table(tmp_path)[0]
    assert (best["model"], best["best_on"]) == ("blinn_phong", "1")


def test_stand_ins_are_spread_over_the_list():
    shared_data("merl_standins")
    chosen = merl_ranking.chosen(20)
    assert len(set(chosen)) == 20
    assert {chosen[0], chosen[-1]} <= set(merl_standins.names())


def test_oren_nayar_gains_on_a_matte_sample(tmp_path):
    shared_data("curet")
    curet_matte.main(tmp_path, samples=(10,), models=("lambert", "oren_nayar"))
    (row,) = table(tmp_path)
    assert float(row["oren_nayar_gain"]) > 2.5


def test_oren_nayar_cannot_describe_ptfe(tmp_path):
    shared_data("nist_ptfe")
    ptfe.main(tmp_path, models=("lambert", "oren_nayar"), starts=2)
    for row in table(tmp_path):
        assert float(row["relative_rms_percent"]) == pytest.approx(7.88, abs=0.05)
        assert float(row["forward_over_back"]) == pytest.approx(1, abs=1e-3)
    run = tomllib.loads((tmp_path / "run.toml").read_text())
    assert run["forward_over_back_measured"] > 1.05


def test_ratio_of_forward_to_back_is_that_of_the_data():
    def tilted(degrees):
        angle = np.radians(degrees)
        return [np.sin(angle), 0, np.cos(angle)]

    wi, wo = np.array([tilted(-60)] * 2), np.array([tilted(54), tilted(-52)])
    mask = np.ones((2, 1), bool)
    data = Measurement(wi, wo, np.array([[0.3], [0.2]]), mask=mask)
    assert ptfe.forward_over_back(ptfe.measured(data)) == pytest.approx(1.5)


def test_a_ball_without_gloss_misses_the_highlight(tmp_path):
    shared_data("sphere_photos", "diligent_ball")
    ball_gloss.main(tmp_path, models=("lambert",), starts=1)
    row, common, own = table(tmp_path)
    assert float(row["image_error_percent"]) == pytest.approx(13.8, abs=0.2)
    assert float(common["image_error_percent"]) == pytest.approx(6.7, abs=0.1)
    assert float(own["in_highlight_percent"]) < float(common["in_highlight_percent"])
    assert float(row["in_highlight_percent"]) > 5 * float(row["elsewhere_percent"])


def test_texels_without_gloss_miss_the_highlight_under_a_new_light(tmp_path):
    folder = shared_data("sphere_photos", "diligent_ball")
    surface = open_surface(folder, tmp_path / "stack.zarr")
    ways = [("lambert", ball_texture.OWN)]
    number = surface.photographs.index(ball_texture.SHOWN)
    found = ball_texture.predictions(surface, brdffit.load(folder), [number], ways)
    (row,) = ball_texture.rows_of(list(found))
    assert row["error_percent"] == pytest.approx(18.9, abs=0.3)
    assert row["in_highlight_percent"] > 5 * row["elsewhere_percent"]
    assert 99.8 < row["converged_percent"] < 100  # 21 see the held-out light alone
