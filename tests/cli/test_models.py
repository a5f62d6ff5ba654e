import json

import pytest

from brdffit import MODELS


def test_the_catalogue_has_a_line_for_every_model(run):
    status, out, err = run("models")
    assert (status, err) == (0, "")
    lines = {line.split()[0]: line for line in out.splitlines() if line.strip()}
    assert set(MODELS) <= set(lines)
    assert "albedo, sigma" in lines["oren_nayar"]
    reciprocal, energy_conserving = lines["ggx"].split("alpha")[1].split()[:2]
    assert (reciprocal, energy_conserving) == ("yes", "no")


@pytest.mark.parametrize("name", MODELS)
def test_every_model_is_described_in_full(run, name):
    status, out, _ = run("models", name)
    assert status == 0
    for part in ("$$f_r", "Range:", "Source:", "typical", "Reciprocal:"):
        assert part in out


def test_json_holds_bounds_units_and_formula(run):
    facts = json.loads(run("models", "oren_nayar", "--json")[1])
    sigma = facts["parameters"]["sigma"]
    assert sigma["unit"] == "rad"
    assert sigma["bounds"][0] == 0
    assert not sigma["per_channel"]
    assert "f_r" in facts["formula"][0]
    catalogue = json.loads(run("models", "--json")[1])["models"]
    assert [entry["name"] for entry in catalogue] == list(MODELS)


def test_the_nearest_name_is_suggested(run):
    status, out, err = run("models", "oren_nayer")
    assert (status, out) == (2, "")
    assert "Did you mean `oren_nayar`?" in err
