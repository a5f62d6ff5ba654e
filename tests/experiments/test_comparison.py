"""Three classic models side by side, and the pictures of the catalogue."""

import csv
import tomllib

import jax
import numpy as np
import pytest
from PIL import Image

from experiments import (
    catalogue,
    comparison_figures,
    comparison_sets,
    introduction,
    model_comparison,
)


@pytest.fixture(autouse=True)
def as_a_script(monkeypatch):
    """Only the package must spell out every broadcast; no program is kept."""
    monkeypatch.setenv("BRDFFIT_CACHE", "off")
    with jax.numpy_rank_promotion("allow"):
        yield


def table(folder, name="table"):
    with open(folder / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_the_true_model_explains_its_own_data(tmp_path, monkeypatch):
    for module in (model_comparison, comparison_figures):
        monkeypatch.setattr(module, "CLASSIC", ("phong", "oren_nayar"))
        monkeypatch.setattr(module, "RESIDUALS", ("log",))
    monkeypatch.setattr(comparison_figures, "SHOWN", "log")
    names = ["simulated phong", "simulated oren_nayar"]
    model_comparison.main(tmp_path, 250, 12, 2, names)
    for line in table(tmp_path, "winners"):
        truth = line["material"].partition(" ")[2]
        assert line["log"] == line["ciede2000_model"] == truth
        assert float(line["ciede2000"]) < 0.2
    run = tomllib.loads((tmp_path / "run.toml").read_text())
    assert "changes the winner on 0 of 2" in run["finding"]
    assert {"spheres.png", "lobes.png", "figure.png"} <= set(run["sha256"])
    found = {(r["model"], r["parameter"]): r for r in table(tmp_path, "parameters")}
    own = found["phong", "exponent"]
    away = abs(float(own["value"]) - 60)
    assert away < 5 * float(own["standard_error"])


def test_a_sphere_is_the_render_of_its_material():
    brdf = comparison_sets.MODELS["lambert"](albedo=[0.6, 0.3, 0.1])
    image, values = comparison_sets.sphere(comparison_sets.modelled(brdf), 16)
    scene = comparison_sets.lit_sphere(16, comparison_sets.LIGHTS)
    wanted = catalogue.render(brdf, scene)
    seen = np.isfinite(image).all(axis=-1)
    assert image[seen] == pytest.approx(wanted[seen], rel=1e-5, abs=1e-7)
    assert values.max() == pytest.approx(wanted.max(), rel=1e-5)


def test_spheres_of_models_are_small_and_round(tmp_path):
    catalogue.main(tmp_path, ["lambert", "conductor_ggx"], resolution=48)
    picture = Image.open(tmp_path / "lambert.png")
    assert picture.size == (catalogue.SMALL,) * 2
    pixels = np.asarray(picture)
    assert pixels[0, 0, 3] == 0
    middle = pixels[catalogue.SMALL // 2, catalogue.SMALL // 2].astype(int)
    assert middle[3] == 255
    assert middle[0] > middle[1] > middle[2]  # copper


def test_the_introduction_says_who_wins_and_by_how_much(tmp_path):
    introduction.main(tmp_path, ("lambert", "phong"), ("lambert", "phong"))
    run = tomllib.loads((tmp_path / "run.toml").read_text())
    first, second = run["finding"].split("; ")
    assert first.startswith("phong explains the metallic paint ")
    assert first.endswith(" times better than lambert")
    assert second.startswith("phong explains the simulated sphere ")
