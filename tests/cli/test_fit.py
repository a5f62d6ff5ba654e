import json
from functools import partial
from pathlib import Path

import pytest

import brdffit
from brdffit.fit import RESIDUALS

FIGURES = ("lobes", "spheres", "residuals")


def test_a_fit_says_what_it_found_and_how_sure_it_is(run, chalk):
    status, out, err = run("fit", chalk, "--model", "lambert")
    words = " ".join(out.split())
    assert (status, err) == (0, "")
    assert "lambert fitted to chalk: 81 values, residual log." in words
    assert "parameter value error unit range note albedo 0.60" in words
    assert "[0, 1]" in words
    assert all(residual in words for residual in RESIDUALS)
    assert "minimised" in words
    assert "Chi-square" in words  # the errors of the values are known
    assert "The fit converged" in words
    assert "Path: " in words
    assert "Written" not in words


def test_json_is_the_whole_result_and_nothing_else(run, chalk):
    status, out, err = run("fit", chalk, "--model", "lambert", "--json")
    result = json.loads(out)
    assert (status, err) == (0, "")
    assert result["model"] == "lambert"
    assert result["parameters"]["albedo"][0] == pytest.approx(0.6, abs=0.01)
    assert result["files"] == []


def test_out_holds_result_and_pictures_whole(run, chalk, tmp_path):
    folder = tmp_path / "new" / "folder"
    status, out, _ = run("fit", chalk, "--model", "lambert", "--out", folder)
    assert status == 0
    pictures = {f"{name}.{kind}" for name in FIGURES for kind in ("png", "pdf")}
    assert {path.name for path in folder.iterdir()} == {"result.json", *pictures}
    assert str(folder) in out.replace("\n", "")
    assert brdffit.load_result(folder / "result.json").model == "lambert"


def test_a_report_alone_is_one_file_in_this_folder(run, chalk, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("fit", "--report", chalk, "--model", "lambert")
    assert (status, err) == (0, "")
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]
    assert str(tmp_path) in out.replace("\n", "")
    html = Path("report.html").read_text(encoding="utf-8")
    assert all(word in html for word in ("chalk.csv", "brdffit table", "lambert"))


def test_a_parameter_can_be_held(run, chalk):
    fit = ("fit", chalk, "--model", "oren_nayar", "--fix", "sigma=0.5", "--json")
    result = json.loads(run(*fit)[1])
    assert result["parameters"]["sigma"] == 0.5
    assert result["standard_errors"]["sigma"] == 0.0


def test_residual_and_starts_are_obeyed(run, chalk):
    options = ("--residual", "plain", "--starts", "3", "--json")
    result = json.loads(run("fit", chalk, "--model", "lambert", *options)[1])
    assert (result["residual"], result["starts"]) == ("plain", 3)


def test_a_share_of_the_samples_is_stated(run, chalk):
    options = ("--samples", "40", "--json")
    result = json.loads(run("fit", chalk, "--model", "lambert", *options)[1])
    assert result["data"] == "chalk (40 of 81 samples)"
    assert result["count"] == 40


def test_a_fit_that_did_not_converge_has_status_1(run, chalk, monkeypatch):
    monkeypatch.setattr(brdffit, "fit", partial(brdffit.fit, max_steps=1))
    status, out, _ = run("fit", chalk, "--model", "phong")
    assert status == 1
    assert "before it converged" in " ".join(out.split())


def test_intervals_and_a_loss_are_had_on_request(run, chalk, tmp_path):
    ask = ("fit", chalk, "--model", "oren_nayar", "--starts", "1", "--loss", "huber")
    found = json.loads(run(*ask, "--bootstrap", "3", "--json")[1])
    assert found["loss"] == "huber"
    assert found["bootstrap"]["resamples"] == 3
    assert found["bootstrap"]["intervals"]["albedo"][0][0] == pytest.approx(0.6, 0.1)
    words = ("--profile", "albedo", "--tied", "albedo", "--fix", "sigma=0")
    ask = ("fit", chalk, "--model", "oren_nayar", "--starts", "1", *words)
    status, out, err = run(*ask, "--out", tmp_path)
    assert (status, err) == (0, "")
    assert "Profile: albedo lies between 0.59" in " ".join(out.split())
    assert (tmp_path / "profile.png").stat().st_size > 1000


def test_a_prior_without_its_deviation_is_refused(run, chalk):
    ask = ("fit", chalk, "--model", "oren_nayar", "--prior", "sigma=0.3")
    status, out, err = run(*ask)
    assert (status, out) == (2, "")
    assert "prior of `sigma` must be a mean and a standard deviation" in err
