"""A few texels, in this process, without the contestant that must be compiled."""

import csv

from benchmarks import ceres, texture_fit, texture_fit_of_one


def test_contestants_are_judged_by_the_minima_that_they_find(tmp_path, monkeypatch):
    monkeypatch.setattr(texture_fit, "one", texture_fit_of_one.measure)
    monkeypatch.setattr(texture_fit_of_one.os, "sched_setaffinity", lambda *_: None)
    monkeypatch.setattr(ceres, "why_absent", lambda: "It takes too long here.")
    monkeypatch.setattr(texture_fit, "facts", lambda turns: {"turns": turns})
    texture_fit.main(tmp_path, models=("oren_nayar",), texels=64, few=6, turns=1)
    with open(tmp_path / "table.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    names = [row["contestant"] for row in rows]
    assert names == ["brdffit", "scipy least_squares, a loop", "brdffit"]
    assert [row["threads"] for row in rows] == ["1", "1", "2"]
    assert all(float(row["right"].rstrip("%")) > 90 for row in rows)
    assert float(rows[0]["texels_per_s"]) > float(rows[1]["texels_per_s"])
    assert (tmp_path / "figure.png").stat().st_size > 1000
