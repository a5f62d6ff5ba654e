import csv
import json

import pytest

import brdffit
from brdffit.cli.compare import MODELS

FIGURES = ("lobes", "spheres", "residuals", "ranking")


def read_csv(path):
    return list(csv.DictReader(path.read_text().splitlines()))


def test_ranking_and_parameters_of_every_model_are_printed(run, chalk, tmp_path):
    models = "lambert,oren_nayar"
    out_folder = tmp_path / "out"
    ask = ("compare", chalk, "--models", models, "--out", out_folder, "--report")
    status, out, err = run(*ask)
    words = " ".join(out.split())
    assert (status, err) == (0, "")
    for heading in ("held-out", "rms, all", "AICc", "CIEDE", "Delta E", "seconds"):
        assert heading in words
    assert "1 lambert" in words or "1 oren_nayar" in words
    assert "parameter" in words
    assert "albedo" in words
    assert "\N{PLUS-MINUS SIGN}" in words
    assert "are tied" in words  # both are a constant here
    pictures = {f"{name}.{kind}" for name in FIGURES for kind in ("png", "pdf")}
    results = {"comparison.json", "lambert.json", "oren_nayar.json", "report.html"}
    tables = {"ranking.csv", "parameters.csv"}
    assert {p.name for p in out_folder.iterdir()} == pictures | results | tables

    ranking = read_csv(out_folder / "ranking.csv")
    assert {row["model"] for row in ranking} == set(models.split(","))
    assert float(ranking[0]["held_out_error"]) == pytest.approx(0.01, rel=0.5)
    assert [float(row["ciede2000"]) < 0.1 for row in ranking] == [True, True]
    assert [float(row["delta_e_itp"]) < 0.5 for row in ranking] == [True, True]
    parameters = read_csv(out_folder / "parameters.csv")
    assert {(row["model"], row["parameter"]) for row in parameters} == {
        ("lambert", "albedo"),
        ("oren_nayar", "albedo"),
        ("oren_nayar", "sigma"),
    }
    assert brdffit.load_result(out_folder / "oren_nayar.json").model == "oren_nayar"


def test_json_is_the_whole_comparison_and_nothing_else(run, chalk):
    status, out, err = run(
        "compare", chalk, "--models", "lambert", "--seed", "7", "--json"
    )
    comparison = json.loads(out)
    assert (status, err) == (0, "")
    assert [entry["model"] for entry in comparison["ranking"]] == ["lambert"]
    assert comparison["seed"] == 7
    assert set(comparison["ranking"][0]["colour"]) == {"ciede2000", "itp"}


def test_the_default_models_are_in_the_catalogue():
    assert set(MODELS.split(",")) <= set(brdffit.MODELS)
