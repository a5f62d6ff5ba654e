import json

import numpy as np

import brdffit
from brdffit import MODELS, images
from tests.results import result_of

SMALL = ("--resolution", "16")


def test_a_named_model_is_rendered_with_scene_and_preview(run, tmp_path):
    path = tmp_path / "ball.exr"
    words = ("render", "phong", "--set", "exponent=40", *SMALL, "--out", path)
    status, out, err = run(*words)
    assert (status, err) == (0, "")
    assert {p.name for p in tmp_path.iterdir()} == {"ball.exr", "ball.toml", "ball.png"}
    assert "Rendered phong" in out
    expected = brdffit.render(MODELS["phong"](exponent=40.0), brdffit.lit_sphere(16))
    np.testing.assert_allclose(images.read(path)[0], expected, rtol=1e-5)


def test_a_saved_result_is_rendered_with_changes(run, tmp_path):
    saved, path = tmp_path / "fit.json", tmp_path / "ball.exr"
    result_of(MODELS["lambert"](albedo=[0.1, 0.2])).save(saved)
    words = (saved, "--set", "albedo=0.3,0.4", *SMALL, "--out", path, "--json")
    facts = json.loads(run("render", *words)[1])
    assert facts["material"]["parameters"]["albedo"] == [0.3, 0.4]
    pixels, channels = images.read(path)
    assert len(channels) == 2
    np.testing.assert_allclose(pixels[..., 1], pixels[..., 0] * 4 / 3, rtol=1e-5)
