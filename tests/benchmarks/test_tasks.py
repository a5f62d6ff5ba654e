"""Every task in a tiny size, and the models that are written out in C++."""

import csv
import json
import tomllib
from types import SimpleNamespace

import jax
import numpy as np
import pytest

from benchmarks import (
    absent,
    ceres,
    cold_start,
    gonio_fit,
    growth,
    growth_of_one,
    many_starts,
    megapixels,
    merl_fit,
    merl_load,
    plain,
    problems,
    sphere_fit,
)
from benchmarks.measure import check
from benchmarks.ours import solve_alone
from brdffit.parameters import values

needs_ceres = pytest.mark.skipif(
    ceres.why_absent() is not None, reason=ceres.why_absent() or ""
)


@pytest.fixture(autouse=True)
def as_a_script():
    """Only the package must spell out every broadcast."""
    with jax.numpy_rank_promotion("allow"):
        yield


@pytest.fixture(autouse=True)
def few(monkeypatch):
    """Of the contestants only those that compile quickly; turns that end at once."""

    def field(problem):
        return [
            solve_alone(problem, "float64"),
            plain.scipy_lm(problem, analytic=True),
            *ceres.contestants(problem),
        ]

    monkeypatch.setattr("benchmarks.field.field", field)
    monkeypatch.setattr(merl_fit, "field", field)
    monkeypatch.setattr("benchmarks.measure.TURN", 0.0)


def table(folder):
    run = tomllib.loads((folder / "run.toml").read_text())
    assert {"commit", "processor", "threads", "load", "peers"} <= set(run)
    assert (folder / "figure.png").stat().st_size > 1000
    with open(folder / "table.csv", newline="") as file:
        return list(csv.DictReader(file))


def check_contest(folder):
    rows = table(folder)
    assert {row["answer"] for row in rows} == {"right"}
    assert all(float(row["over_float32"]) > 0 for row in rows)
    assert all(float(row["least_ms"]) <= float(row["ms"]) for row in rows)


def test_spheres_are_fitted_by_all_to_the_same_optimum(tmp_path):
    sphere_fit.main(tmp_path, [("ggx", 1)], turns=2, resolution=16)
    check_contest(tmp_path)


def test_goniometer_tables_are_fitted_by_all_to_the_same_optimum(tmp_path):
    gonio_fit.main(tmp_path, samples=600, turns=1)
    check_contest(tmp_path)


def test_cells_of_merl_files_are_fitted_by_all_to_the_same_optimum(tmp_path):
    merl_fit.main(tmp_path, turns=1, every=2000)
    check_contest(tmp_path)


def test_many_starts_are_counted_in_single_fits(tmp_path, monkeypatch):
    asked = []

    def whole_fit(problem, precision, starts=1):
        asked.append(starts)
        return solve_alone(problem, precision)

    monkeypatch.setattr(many_starts, "whole_fit", whole_fit)
    monkeypatch.setattr(
        many_starts.plain,
        "optimistix",
        lambda problem, _: solve_alone(problem, "float64"),
    )
    many_starts.main(tmp_path, ["ggx"], turns=1, resolution=16)
    check_contest(tmp_path)
    assert asked == [1, 1, 64, 64]


@needs_ceres
@pytest.mark.parametrize("model", problems.TRUTHS)
def test_models_and_derivatives_in_c_are_those_of_brdffit(model):
    problem = problems.sphere(model, 3, 16)
    scipy = plain.scipy_lm(problem, analytic=False)
    entries = check([scipy, *ceres.contestants(problem)], problem.cost)
    assert all(entry.right for entry in entries)
    assert all(entry.steps < 50 for entry in entries)


@needs_ceres
def test_a_model_that_is_not_written_in_c_is_refused():
    problem = problems.sphere("ggx", 1, 16)
    other = problems.brdffit.MODELS["lambert"]()
    with pytest.raises(ValueError, match="lambert"):
        ceres.Fit(problems.Problem(other, problem.samples, problem.residual), False)


def test_without_a_compiler_ceres_is_left_out_with_a_sentence(monkeypatch, capsys):
    monkeypatch.setattr(ceres, "COMPILER", "no-such-compiler")
    assert ceres.contestants(None) == []
    assert "no-such-compiler" in capsys.readouterr().out


def test_cold_starts_are_compared_with_imports_turn_by_turn(tmp_path, monkeypatch):
    answer = json.dumps({"parameters": {"alpha": 0.1226}})
    found = {
        cold_start.EMPTY: [(4.0, 5.0, answer), (6.0, 7.0, answer)],
        cold_start.WARM: [(2.0, 2.0, answer), (2.0, 2.0, answer)],
        cold_start.IMPORTS: [(1.0, 1.0, ""), (2.0, 2.0, "")],
    }
    monkeypatch.setattr(cold_start, "turns_of", lambda *_: found)
    cold_start.main(tmp_path, turns=2, resolution=16)
    empty, warm, _ = table(tmp_path)
    assert empty["over_imports"] == "3.50"
    assert warm["over_imports"] == "1.50"
    found[cold_start.WARM][1] = (2.0, 2.0, answer.replace("0.12", "0.13"))
    cold_start.main(tmp_path, turns=2, resolution=16)
    assert table(tmp_path)[1]["answer"] == "wrong"
    assert table(tmp_path)[1]["over_imports"] == ""


def test_growth_is_a_slope_of_logarithms(tmp_path, monkeypatch):
    def one(samples, starts, precision, turns):
        return {
            "samples": samples,
            "starts": starts,
            "precision": precision,
            "seconds": 1e-6 * samples**0.9 * turns**0,
            "peak_mb": 1.0,
            "data_mb": 1.0,
        }

    monkeypatch.setattr(growth, "one", one)
    _, slopes = growth.main(tmp_path, samples=(10**3, 10**5, 10**6), starts=(1, 2))
    assert slopes["float64"] == pytest.approx(0.9)
    assert len(table(tmp_path)) == 10


def test_time_and_memory_of_one_size_are_measured(monkeypatch):
    def fit(model, measurement, starts, **_):
        assert (model, starts) == ("ggx", 1)
        assert measurement.f_r.shape == (1000, 3)
        np.ones((8000, 1000)).sum()  # 64 MB, which no heap keeps: the peak must show
        right = values(problems.truth("ggx"))
        errors = dict.fromkeys(right, 0.01)
        return SimpleNamespace(parameters=right, standard_errors=errors)

    monkeypatch.setattr(problems.brdffit, "fit", fit)
    found = growth_of_one.measure(1000, 1, "float64", turns=1)
    assert found["answer"] == "right"
    assert found["seconds"] > 0
    assert found["data_mb"] == pytest.approx(1000 * 9 * 4 / 2**20, abs=1e-3)
    assert found["peak_mb"] > 1


def test_effects_that_are_absent_are_timed_for_all_scenes(tmp_path):
    absent.main(tmp_path, turns=1, resolution=8)
    assert [row["scene"] for row in table(tmp_path)[::3]] == list(absent.SCENES)
    assert all(float(row["ratio"]) > 0 for row in table(tmp_path))


def test_spheres_are_rendered_beside_mitsuba(tmp_path):
    pytest.importorskip("mitsuba")
    megapixels.main(tmp_path, turns=1, resolution=16)
    speeds = [float(row["megapixels_per_s"]) for row in table(tmp_path)]
    assert len(speeds) == 9
    assert min(speeds) > 0


def test_a_merl_file_is_read_in_bounded_memory(tmp_path):
    rows = merl_load.main(tmp_path, turns=1, tasks={"load": merl_load.TASKS["load"]})
    assert rows[0]["peak_megabytes"] < 500
