"""Every experiment in a reduced version, and what all of them rest on."""

import csv
import tomllib
import zlib

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from experiments import (
    anisotropy,
    classic_scenes,
    hostile_input,
    metal_highlight,
    million_pairs,
    original_phong,
    probe_directions,
    shadow_maps,
    six_materials,
    stability,
    textbook,
)
from experiments.hard_cases import cases
from experiments.hard_cases_truth import TOO_SLOW
from tests.oracle import ORACLE
from tests.oracle.cases import everyday


@pytest.fixture(autouse=True)
def as_a_script():
    """Only the package must spell out every broadcast."""
    with jax.numpy_rank_promotion("allow"):
        yield


def table(folder, name="table"):
    with open(folder / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def check_record(folder, *figures):
    run = tomllib.loads((folder / "run.toml").read_text())
    assert {"seconds", "commit", "processor", "threads", "packages"} <= set(run)
    for figure in figures or ("figure",):
        for suffix in ("png", "pdf"):
            assert (folder / f"{figure}.{suffix}").stat().st_size > 1000


@pytest.mark.parametrize("name", sorted(textbook.MODELS))
def test_printed_formula_is_right_where_nothing_is_hard(name):
    """A formula that fails must fail by rounding, not by a slip in typing it."""
    random = np.random.default_rng(zlib.crc32(name.encode()))
    chosen = {p: float(x) for p, x in everyday(name, random).items()}
    if name == "he":
        chosen |= {"sigma0": 0.08, "tau": 1.7}  # what forty orders can hold
    wi, wo = np.array([0.36, 0.48, 0.8]), np.array([-0.28, -0.576, 0.768])
    with jax.enable_x64(True):
        arrays = {p: jnp.float64(x) for p, x in chosen.items()}
        found = textbook.MODELS[name](jnp.asarray(wi), jnp.asarray(wo), **arrays)
        ours = stability.ours(name)(arrays, jnp.asarray(wi), jnp.asarray(wo))
    assert float(found) == pytest.approx(float(ours), rel=1e-9)


def test_truth_covers_every_case():
    known = np.load(stability.TRUTH)
    assert set(known) == set(ORACLE) - set(TOO_SLOW)
    for name in known:
        chosen, wi, _ = cases(name)
        assert known[name].shape == (len(wi), 7 + len(chosen))
        assert not np.isnan(known[name][:, 0]).any()


def test_stability_finds_the_printed_formula_wrong_and_ours_right(tmp_path):
    stability.main(tmp_path, ["phong"])
    check_record(tmp_path, "phong", "figure")
    run = tomllib.loads((tmp_path / "run.toml").read_text())
    assert "ours 0 of 234 cases wrong" in run["finding"]
    at = {row["wi, wo"]: row for row in table(tmp_path, "directions")}
    assert int(at["50 deg, mirror"]["printed_value_wrong"]) > 0
    assert all(row["ours_value_wrong"] == "0" for row in at.values())
    bad = {(r["formula"], r["precision"]): int(r["bad"]) for r in table(tmp_path)}
    assert bad["ours", "float32"] == bad["ours", "float64"] == 0
    assert bad["printed", "float32"] > 5


def test_judgement_sees_what_is_lost_and_what_is_off():
    exact = np.ones((4, 8))  # value, one parameter, two directions
    found = exact.copy()
    found[0, 0], found[1, 1], found[2, 4] = np.nan, 1.02, np.inf
    worst = stability.severity(
        stability.judge(found, exact, np.zeros_like(exact), "float32")
    )
    assert list(worst) == [
        stability.VALUE_LOST,
        stability.GRADIENT_OFF,
        stability.GRADIENT_LOST,
        stability.FINE,
    ]


def test_random_pairs_are_counted(tmp_path, monkeypatch):
    monkeypatch.setattr(million_pairs, "BATCH", 2000)
    million_pairs.main(tmp_path, ["phong"], batches=2)
    check_record(tmp_path)
    (row,) = table(tmp_path)
    assert int(row["pairs"]) == 4000
    assert 1000 < int(row["above_horizon"]) < 4000
    assert row["value_not_finite"] == row["by_directions_not_finite"] == "0"


def test_original_phong_gains_energy_and_loses_reciprocity(tmp_path, monkeypatch):
    monkeypatch.setattr(original_phong, "EXPONENTS", (10.0,))
    angles = np.array([0, 60, 84, 84.5, 85, 89.9])
    monkeypatch.setattr(original_phong, "ANGLES", angles)
    monkeypatch.setattr(original_phong, "RESOLUTION", 16)
    monkeypatch.setattr(original_phong, "SHEET_RESOLUTION", 16)
    original_phong.main(tmp_path)
    check_record(tmp_path, "figure", "spheres", "parameters")
    rows = {row["model"]: row for row in table(tmp_path)}
    original = rows.pop("phong_original")
    assert float(original["albedo_above_1_beyond_deg"]) == pytest.approx(84.76, abs=0.1)
    ratio = np.cos(np.radians(80)) / np.cos(np.radians(30))
    assert float(original["there_over_back_30_80deg"]) == pytest.approx(ratio, rel=1e-5)
    for row in rows.values():
        assert row["albedo_above_1_beyond_deg"] == "never"
        assert float(row["there_over_back_30_80deg"]) == pytest.approx(1, rel=1e-5)


def test_ggx_has_the_longer_tail_on_metal(tmp_path, monkeypatch):
    monkeypatch.setattr(metal_highlight, "RESOLUTION", 16)
    metal_highlight.main(tmp_path)
    check_record(tmp_path)
    ggx, _, beckmann, *_ = table(tmp_path)
    width = float(beckmann["half_width_deg"])
    assert float(ggx["half_width_deg"]) == pytest.approx(width, rel=0.03)
    assert float(ggx["at_3_widths"]) > 15 * float(beckmann["at_3_widths"])


def test_fields_of_tangents_turn_the_highlight(tmp_path):
    anisotropy.main(tmp_path, resolution=48)
    check_record(tmp_path)
    for row in table(tmp_path):
        straight = row["tangents"] != "radial"
        assert (float(row["axes"]) > 3) == straight
        assert float(row["angle_deg"]) == pytest.approx(90 if straight else 53, abs=7)
    run = tomllib.loads((tmp_path / "run.toml").read_text())
    assert run["isotropic_difference"] < 1e-5


def test_six_materials_are_shown_with_their_effects(tmp_path, monkeypatch):
    monkeypatch.setattr(six_materials, "TURNS", 1)
    six_materials.main(tmp_path, resolution=24)
    check_record(tmp_path)
    for row in table(tmp_path):
        assert row["effects"].startswith("ambient falloff shadows")
        assert float(row["over_phong"]) > 0
    assert len(table(tmp_path)) == 6


def test_shadow_maps_come_closer_with_every_pixel(tmp_path, monkeypatch):
    monkeypatch.setattr(shadow_maps, "RUNS", 1)
    monkeypatch.setattr(shadow_maps, "MAPS", (16, 32, 256))
    shadow_maps.main(tmp_path, resolution=48)
    check_record(tmp_path)
    for light in shadow_maps.LIGHTS:
        errors = [float(r["error"]) for r in table(tmp_path) if r["question"] == light]
        assert errors[0] == 0
        assert errors[1] > 1.5 * errors[3]


def test_directions_that_a_plan_picks_meet_its_tolerance(tmp_path, monkeypatch):
    monkeypatch.setattr(probe_directions, "RUNS", 1)
    monkeypatch.setattr(probe_directions, "ALPHAS", (0.2,))
    monkeypatch.setattr(probe_directions, "SKY", (32, 64))
    monkeypatch.setattr(probe_directions, "TOLERANCES", (0.1, 0.02))
    probe_directions.main(tmp_path, resolution=8, numbers=(16, 128))
    check_record(tmp_path)
    for row in table(tmp_path, "picked"):
        assert row["said_to_be_met"] == "True"
        assert float(row["error"]) <= float(row["tolerance"])


def test_classic_scenes_are_drawn(tmp_path, monkeypatch):
    monkeypatch.setattr(classic_scenes, "TURNS", 1)
    classic_scenes.main(tmp_path, resolution=12)
    check_record(tmp_path, "probe", "cornell", "local", "bumps", "gooch")
    effects = {row["picture"]: row["effects"].split() for row in table(tmp_path)}
    assert effects["Cornell box: no shadows"] == ["falloff"]
    assert "bounces" in effects["table top: traced"]
    assert effects["bumps of 0"] == ["ambient"]
    assert effects["Gooch: outlines"] == ["style"]


def test_damage_and_traps_are_counted(tmp_path):
    traps = hostile_input.TRAPS[:2]
    hostile_input.main(tmp_path, formats=("fred",), most=3, traps=traps)
    rows = table(tmp_path)
    assert [row["damage"] for row in rows[:4]] == ["cuts", "flips", "words", "numbers"]
    assert len(rows) == 6
    assert {row["wrong"] for row in rows} == {"0"}
    assert all(int(r["read"]) + int(r["refused"]) == int(r["files"]) for r in rows)
