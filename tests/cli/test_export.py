import json

import brdffit
from tests.results import result_of


def test_a_saved_result_is_exported_with_its_error(run, tmp_path):
    result = result_of(brdffit.MODELS["phong"](diffuse=[0.3, 0.2, 0.1], exponent=20))
    result.save(tmp_path / "result.json")
    out = tmp_path / "new" / "gloss.glsl"
    status, text, err = run(
        "export", tmp_path / "result.json", "--to", "glsl", "--out", out
    )
    assert (status, err) == (0, "")
    assert "Relative error of f_r over 4000 pairs" in text
    assert "largest" in text
    assert "Written to" in text
    assert "vec3 brdf(vec3 wi, vec3 wo)" in out.read_text()


def test_json_has_error_and_parameters(run, tmp_path):
    words = ("--to", "merl", "--out", tmp_path / "x.binary", "--json")
    status, text, _ = run("export", "lambert", "--set", "albedo=0.5", *words)
    done = json.loads(text)
    assert status == 0
    assert done["deviation"]["largest"] < 1e-6
    assert done["target"] == "merl"


def test_wrong_words_are_refused_in_a_sentence(run, tmp_path):
    def refused(*words):
        status, out, err = run("export", *words)
        assert (status, out) == (2, "")
        assert err.count("\n") == 1
        return err

    out = ("--out", tmp_path / "x.glsl")
    assert "Did you mean `glsl`?" in refused("ggx", "--to", "glls", *out)
    assert "must end in .xml" in refused("ggx", "--to", "mitsuba", *out)
    assert "Did you mean `ggx`?" in refused("gxx", "--to", "glsl", *out)
    spectral = result_of(brdffit.MODELS["lambert"](albedo=[0.1, 0.2]))
    spectral.save(tmp_path / "two.json")
    words = (tmp_path / "two.json", "--to", "glsl", *out)
    assert "has the channels a, b: fit the data in RGB" in refused(*words)
    assert not (tmp_path / "x.glsl").exists()
