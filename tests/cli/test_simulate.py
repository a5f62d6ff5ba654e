import json
import tomllib

import numpy as np
import pytest

import brdffit
from brdffit import images


def test_a_table_holds_what_the_model_says_and_its_truth(run, tmp_path):
    path = tmp_path / "chalk.csv"
    settings = ("--model", "lambert", "--set", "albedo=0.8,0.5,0.2")
    status, out, err = run("simulate", *settings, "--out", path)
    assert (status, err) == (0, "")
    assert path.name in out
    data = brdffit.load(path)
    np.testing.assert_allclose(
        data.f_r * np.pi, [[0.8, 0.5, 0.2]] * len(data), rtol=1e-6
    )
    assert data.name == "chalk"
    assert '"albedo": [0.8, 0.5, 0.2]' in path.read_text()


def test_angles_of_a_table_are_those_asked_for(run, tmp_path):
    path = tmp_path / "chalk.csv"
    angles = ("--theta-i", "20,40", "--theta-o", "0,30", "--phi", "0,90,180")
    run("simulate", "--model", "lambert", *angles, "--out", path)
    data = brdffit.load(path)
    assert len(data) == 2 * 2 * 3
    theta_i = np.degrees(np.arccos(data.wi[:, 2]))
    np.testing.assert_allclose(np.unique(theta_i.round(3)), [20, 40])


def test_noise_has_the_size_and_the_seed_asked_for(run, tmp_path):
    def noisy(seed):
        path = tmp_path / f"{seed}.csv"
        options = ("--noise", "0.05", "--seed", seed, "--channels", "650nm")
        run("simulate", "--model", "lambert", *options, "--out", path)
        return brdffit.load(path)

    first, second = noisy(1), noisy(2)
    assert first.channels == ("650nm",)
    assert np.std(first.f_r) / np.mean(first.f_r) == pytest.approx(0.05, rel=0.2)
    assert not np.array_equal(first.f_r, second.f_r)
    np.testing.assert_array_equal(first.f_r, noisy(1).f_r)


def test_an_image_can_be_fitted_as_it_stands(run, tmp_path):
    path = tmp_path / "ball.exr"
    scene = ("--lights", "2", "--resolution", "24")
    model = ("--model", "lambert", "--set", "albedo=0.8,0.5,0.2")
    status, _, _ = run("simulate", *model, *scene, "--out", path)
    assert status == 0
    assert {p.name for p in tmp_path.iterdir()} == {"ball.exr", "ball.toml", "ball.png"}
    data = brdffit.load(path)
    assert data.wi.shape[1] == 2
    assert data.pixels.shape == (1, 24, 24)
    result = brdffit.fit("lambert", data)
    np.testing.assert_allclose(result.parameters["albedo"], [0.8, 0.5, 0.2], rtol=1e-5)


def test_a_sum_of_models_is_simulated_by_its_name(run, tmp_path):
    path = tmp_path / "ball.exr"
    settings = ("--set", "first.albedo=0.5", "second.alpha=0.1")
    words = ("--model", "lambert+ggx_lobe", *settings, "--resolution", "8")
    facts = json.loads(run("simulate", *words, "--out", path, "--json")[1])
    assert facts["truth"]["model"] == "sum"
    assert facts["truth"]["second"]["parameters"]["alpha"] == 0.1
    truth = tomllib.loads(path.with_suffix(".toml").read_text())["provenance"]
    assert truth == facts["truth"]


def test_lights_are_spread_evenly_around_the_viewer(run, tmp_path):
    path = tmp_path / "ball.exr"
    shape = ("--lights", "3", "--resolution", "8")
    run("simulate", "--model", "lambert", *shape, "--out", path)
    lights = brdffit.load_scene(path.with_suffix(".toml")).lights
    directions = np.array([light.direction for light in lights])
    cosines = directions @ directions.T
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-9)
    np.testing.assert_allclose(cosines[np.triu_indices(3, 1)], cosines[0, 1])


def test_an_own_scene_is_used(run, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'camera = {kind = "orthographic", resolution = 8}\n'
        'shapes = [{kind = "sphere"}]\n'
        'lights = [{kind = "directional", direction = [0, 0, 1], irradiance = 2.0}]\n'
    )
    path = tmp_path / "ball.exr"
    status, _, _ = run(
        "simulate", "--model", "lambert", "--scene", scene, "--out", path
    )
    assert status == 0
    pixels, _ = images.read(path)
    middle = pixels[4, 4].mean() * np.pi / 0.5  # of the default albedo
    assert middle == pytest.approx(2.0, rel=0.02)
