import json

from brdffit.cli.demo import EXAMPLE, MODELS


def test_the_demo_finds_the_truth_and_tells_where_everything_is(run, tmp_path):
    folder = tmp_path / "demo"
    status, out, err = run("demo", "--out", folder, "--json")
    outcome = json.loads(out)
    assert (status, err) == (0, "")
    assert [entry["model"] for entry in outcome["ranking"]][0] == "ggx+ggx_lobe"
    assert len(outcome["ranking"]) == len(MODELS.split(","))
    best = outcome["ranking"][0]
    assert best["p_value"] > 0.01
    assert {str(path) for path in folder.iterdir()} == set(outcome["files"])


def test_the_example_belongs_to_the_package():
    assert EXAMPLE.is_file()
    assert "simulated" in EXAMPLE.read_text()[:500]
