import json
import runpy
from pathlib import Path

import numpy as np
import pytest

from brdffit import images
from brdffit.readers import load, table
from brdffit.render import description
from brdffit.scene import load_scene
from brdffit.scene.sidecar import load_toml

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "data_synthetic"
EXAMPLE = ROOT / "brdffit" / "example"

MAKE = runpy.run_path(str(FOLDER / "make.py"))
SPHERES, TABLES = MAKE["MANIFEST"]["spheres"], MAKE["MANIFEST"]["tables"]


def test_the_folders_hold_what_the_manifest_says_and_nothing_else():
    spheres = [(FOLDER / s["file"]).with_suffix("") for s in SPHERES]
    made = {p.with_suffix(end) for p in spheres for end in (".exr", ".toml", ".png")}
    made |= {(FOLDER / entry["file"]).resolve() for entry in TABLES}
    made |= {FOLDER / "make.py", FOLDER / "manifest.toml"}
    found = [*FOLDER.iterdir(), *EXAMPLE.iterdir()]
    assert {path for path in found if path.name != "__pycache__"} == made
    assert sum(path.stat().st_size for path in made) < 3e6


def test_a_sphere_made_again_is_the_same(tmp_path):
    entry = next(s for s in SPHERES if s["file"] == "cook_torrance_three_lights.exr")
    again = MAKE["make_sphere"](entry, tmp_path)
    for path in (again, FOLDER / entry["file"]):
        assert images.read(path).channels == ("R", "G", "B")
    np.testing.assert_allclose(
        images.read(again).pixels,
        images.read(FOLDER / entry["file"]).pixels,
        rtol=1e-5,
    )
    sidecar = FOLDER / entry["file"].replace(".exr", ".toml")
    assert load_toml(again.with_suffix(".toml")) == load_toml(sidecar)


@pytest.mark.parametrize("entry", TABLES[1:], ids=lambda entry: entry["name"])
def test_a_table_made_again_is_the_same(entry, tmp_path):
    (tmp_path / "brdffit" / "example").mkdir(parents=True)
    (tmp_path / "here").mkdir()
    again = MAKE["make_table"](entry, tmp_path / "here")
    new, old = table.load(again), table.load(FOLDER / entry["file"])
    for name in ("wi", "wo", "f_r", "sigma"):
        np.testing.assert_allclose(
            getattr(new, name), getattr(old, name), rtol=1e-5, atol=1e-7
        )
    assert new.name == old.name == entry["name"]


@pytest.mark.parametrize("entry", SPHERES, ids=lambda entry: entry["file"])
def test_an_image_is_the_render_of_its_sidecar(entry):
    path = FOLDER / entry["file"]
    truth = load_toml(path.with_suffix(".toml"))["provenance"]
    brdf = MAKE["from_description"](MAKE["MANIFEST"]["materials"][entry["material"]])
    assert truth | description(brdf) == truth
    assert truth["noise"]["relative"] == truth["noise"]["additive"] == 0
    assert (
        len(load_scene(path.with_suffix(".toml")).lights)
        == ({"one": 1, "three": 3}[entry["lights"]])
    )
    samples = load(path)
    expected = MAKE["simulate_image"](brdf, load_scene(path.with_suffix(".toml")))
    np.testing.assert_allclose(samples.value, expected.value, rtol=1e-5)
    np.testing.assert_array_equal(samples.wi, expected.wi)


def test_the_two_tables_of_one_material_differ_by_the_stated_noise():
    clean, noisy = (table.load(FOLDER / entry["file"]) for entry in TABLES[:2])
    np.testing.assert_array_equal(clean.wi, noisy.wi)
    np.testing.assert_allclose(noisy.sigma, 0.02 * clean.f_r, rtol=1e-5)
    pull = (noisy.f_r - clean.f_r) / noisy.sigma
    assert 0.95 < np.sqrt(np.mean(pull**2)) < 1.05
    assert clean.sigma is None


def test_the_example_says_that_it_is_simulated_and_from_what():
    entry = TABLES[2]
    lines = (FOLDER / entry["file"]).read_text().splitlines()[:12]
    assert any("simulated by brdffit, not measured" in line for line in lines)
    told = next(line for line in lines if line.startswith("# truth: "))
    truth = json.loads(told.removeprefix("# truth: "))
    brdf = MAKE["from_description"](MAKE["MANIFEST"]["materials"][entry["material"]])
    assert truth | description(brdf) == truth
    assert truth["noise"]["relative"] == 0.02
    assert len(table.load(FOLDER / entry["file"])) == 1575
