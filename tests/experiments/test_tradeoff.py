"""Error against time: fronts, names beside points, and every curve in a tiny size."""

import csv
import itertools
import tomllib

import jax
import numpy as np
import pytest
from matplotlib.text import Text

from brdffit.plots.style import new_figure
from experiments import (
    bounce_depth,
    effect_cost,
    fit_budget,
    forward_models,
    model_cost,
    pareto,
    solvers,
    tradeoff,
)
from experiments.labels import label_points
from tests.data import shared_data


@pytest.fixture(autouse=True)
def as_a_script(monkeypatch):
    """Only the package must spell out every broadcast; turns end at once."""
    monkeypatch.setattr("benchmarks.measure.TURN", 0.0)
    with jax.numpy_rank_promotion("allow"):
        yield


def table(folder):
    run = tomllib.loads((folder / "run.toml").read_text())
    assert any(letter.isdigit() for letter in run["finding"])
    assert (folder / "figure.png").stat().st_size > 1000
    with open(folder / "table.csv", newline="") as file:
        return list(csv.DictReader(file))


def errors(folder, question):
    return {
        row["variant"]: float(row["error"])
        for row in table(folder)
        if row["question"] == question
    }


def line(name, seconds, error, family=""):
    return {
        "question": "q",
        "variant": name,
        "family": family or name,
        "error": error,
        "seconds": seconds,
        "lower_quartile": seconds,
        "upper_quartile": seconds,
    }


def test_the_front_is_what_no_other_beats():
    rows = [line("a", 1, 3), line("b", 2, 3), line("c", 3, 1), line("d", 2.5, 2)]
    assert [row["variant"] for row in tradeoff.front(rows)] == ["a", "d", "c"]
    assert tradeoff.front([line("nan", 1, np.nan)]) == []


def test_variants_are_compiled_once_and_then_take_turns():
    called = []
    variants = [
        tradeoff.Variant(name, lambda n=name: called.append(n), lambda _: 0.5)
        for name in ("one", "two")
    ]
    rows = tradeoff.measured("which", variants, turns=3, share=0.1)
    assert called[:2] == ["one", "two"]  # compiled
    assert called.count("one") == called.count("two") >= 8
    assert [row["error"] for row in rows] == [0.5, 0.5]
    assert all(0 < row["seconds"] < 1e-3 for row in rows)


def test_names_cover_neither_each_other_nor_points():
    random = np.random.default_rng(0)
    figure = new_figure(5.0, 4.0)
    axes = figure.subplots()
    points = random.uniform(0.2, 0.8, (14, 2))
    axes.set(xlim=(0, 1), ylim=(0, 1))
    figure.draw_without_rendering()
    names = [f"variant {n}" for n in range(len(points))]
    assert label_points(axes, points, names) == []
    figure.draw_without_rendering()  # which puts the texts in their places
    renderer = figure.canvas.get_renderer()
    boxes = [Text.get_window_extent(t, renderer).padded(-0.5) for t in axes.texts]
    assert not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2))
    places = axes.transData.transform(points)
    assert not any(box.contains(*place) for box in boxes for place in places)


def test_a_name_without_a_free_place_is_told():
    figure = new_figure(1.5, 1.5)
    axes = figure.subplots()
    axes.set(xlim=(0, 1), ylim=(0, 1))
    figure.draw_without_rendering()
    assert label_points(axes, [(0.5, 0.5)], ["a name that is far too long for it"])


def test_upright_lines_are_what_has_no_error():
    rows = [line("right", 2e-3, 0.0), line("cheap", 1e-3, 0.1), line("no", 1, np.nan)]
    figure = pareto.chart(
        rows, {"q": "t"}, "f", unit="ms", error="error", time_of="one run"
    )
    (axes,) = figure.axes
    assert [text.get_text() for text in axes.texts] == ["cheap"]
    low, high = axes.get_xlim()
    assert low < 1 < 2 < high < 100
    assert "log scale" in axes.get_xlabel()


def test_numbers_at_axes_are_plain():
    shown = [pareto.plain(x) for x in (1e-5, 5e-5, 0.001, 0.02, 2000.0, 1e6)]
    five = r"$5 \times 10^{-5}$"
    assert shown == ["$10^{-5}$", five, "0.001", "0.02", "2,000", "$10^{6}$"]
    assert tradeoff.rounded(30512.0) == "31,000"


def test_schlick_and_the_rational_masking_cost_what_their_docstrings_say(tmp_path):
    chosen = ("Beckmann masking", "Fresnel of gold", "orders of He")
    forward_models.main(tmp_path, count=512, turns=1, chosen=chosen)
    masking = errors(tmp_path, "Beckmann masking")
    assert masking["exact"] < 1e-6
    assert 1e-3 < masking["rational"] < 6.5e-3
    orders = errors(tmp_path, "orders of He")
    assert orders["all orders"] < 1e-5
    assert orders["30 orders"] < 1e-3 < 0.1 < orders["3 orders"] < orders["1 order"]


def test_more_samples_and_starts_bring_parameters_closer(tmp_path, monkeypatch):
    monkeypatch.setattr(fit_budget, "STARTS", (1, 16))
    monkeypatch.setattr(fit_budget, "TOLERANCES", (1e-2, 1e-10))
    monkeypatch.setattr(fit_budget, "PRECISIONS", ("float64",))
    fit_budget.main(tmp_path, (16, 48), (100, 1000), 2, 3, 1, 16)
    for question in ("resolution", "samples", "starts", "tolerance"):
        first, last = errors(tmp_path, question).values()
        assert last < first


def test_solvers_start_and_end_alike(monkeypatch):
    monkeypatch.setattr(solvers, "STEPS", (2, 20))
    monkeypatch.setattr(solvers, "TOLERANCES", (1e-8,))
    monkeypatch.setattr(solvers, "DESCENT", (300,))
    monkeypatch.setattr(solvers, "RATES", (0.02,))
    monkeypatch.setattr(
        solvers.plain, "SOLVERS", {"LM": solvers.plain.optx.LevenbergMarquardt}
    )
    monkeypatch.setattr(solvers, "RTOL", {"float64": 1e-10})
    rows = list(solvers.variants(solvers.problems.sphere("ggx", 1, 16)))
    found = {(v.family, v.name): v.error(v.run()) for v in rows}
    assert found["brdffit float64", "20 steps"] < 1e-6
    for family in ("optimistix LM", "optimistix BFGS", "scipy lm, analytic"):
        assert found[family, "tolerance 1e-08"] < 1e-6
    assert found["Adam, rate 0.02", "300 steps"] < 0.1
    assert found["brdffit float64", "2 steps"] > 0.1


def test_rays_that_are_followed_deeper_show_more(tmp_path):
    bounce_depth.main(tmp_path, 16, (0, 1, 3), 1)
    found = errors(tmp_path, "mirrors and glass")
    assert found["depth 12"] == 0
    assert found["depth 0"] > 2 * found["depth 1"] > 2 * found["depth 3"]


def test_every_effect_of_the_scene_changes_it(tmp_path):
    effect_cost.main(tmp_path, 16, 16, 1)
    found = errors(tmp_path, "scene")
    assert found.pop("all effects") == 0
    assert len(found) == 8
    assert all(error > 1e-4 for error in found.values())
    assert errors(tmp_path, "multiple_scattering")["no multiple scattering"] > 0.05


def test_models_are_compared_on_measured_materials(tmp_path):
    shared_data("nist_ptfe")
    names = ["sintered PTFE", "photographed ball"]
    model_cost.main(tmp_path, ("lambert", "ggx"), names, 300, 256, 1, 2)
    for name in names:
        found = errors(tmp_path, name)
        assert found["ggx"] < found["lambert"]
