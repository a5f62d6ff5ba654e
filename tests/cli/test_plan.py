import json

import pytest

SCENE = """
[camera]
kind = "perspective"
resolution = 24
position = [0, 1, 6]

[[shapes]]
kind = "sphere"

[[shapes]]
kind = "plane"
point = [0, -1, 0]
material = {model = "lambert", albedo = 0.5}

[[lights]]
kind = "point"
position = [2, 4, 3]
intensity = 30
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def test_a_plan_is_a_table_with_reasons(run, scene):
    status, out, err = run("plan", scene, "--model", "phong")
    assert (status, err) == (0, "")
    assert "shadows" in out
    assert "something stands between visible points and a light" in out
    assert "every BRDF is isotropic" in out


def test_a_plan_for_machines_has_errors_and_costs(run, scene):
    words = ("plan", scene, "--without", "falloff", "--json", "--tolerance", "0.01")
    facts = json.loads(run(*words)[1])
    assert facts["tolerance"] == 0.01
    assert facts["effects"]["shadows"]["on"]
    assert facts["effects"]["shadows"]["error"] > 0.01
    assert facts["effects"]["shadows"]["cost"] > 1
    assert facts["effects"]["falloff"]["overridden"]
    assert facts["effects"]["tangents"]["on"]


def test_a_render_says_what_the_user_has_overridden(run, scene, tmp_path):
    words = ("render", "phong", "--scene", scene, "--out", tmp_path / "a.exr")
    _, out, _ = run(*words)
    assert "because it was asked for" not in out
    _, out, _ = run(*words, "--without", "shadows")
    assert "Effect `shadows` is off because it was asked for" in out


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--with", "shadow"), "Effect `shadow` must be one of"),
        (("--with",), "--with requires at least 1 element"),
        (("--with", "bump"), "Effect `bump` needs a height map in the scene."),
        (("--set", "alpha=0.1"), "Option --set needs the model"),
        (("--tolerance", "-1"), "The tolerance must be above 0"),
        (("--within", "all"), "`within` `all` must be one of given, typical, bounds."),
    ],
)
def test_bad_words_get_one_sentence(run, scene, words, sentence):
    status, out, err = run("plan", scene, *words)
    assert (status, out) == (2, "")
    assert sentence in err
