"""Textures of two sizes, tiny, in this process."""

import csv
import tomllib

from benchmarks import cluster, streaming


def test_sizes_are_measured_one_by_one(tmp_path, monkeypatch):
    monkeypatch.setattr(streaming, "one", streaming.measure)
    for module in (cluster, streaming):
        monkeypatch.setattr(module, "MODEL", "lambert")
    monkeypatch.setattr(cluster, "MAPS", {"albedo": (3, 0.05, 0.6)})
    monkeypatch.setattr(streaming, "facts", lambda turns: {"turns": turns})
    streaming.main(tmp_path, sizes=(64, 320), chunk=64)
    with open(tmp_path / "table.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["texels"] for row in rows] == ["64", "320"]
    assert all(float(row["seconds"]) > 0 for row in rows)
    run = tomllib.loads((tmp_path / "run.toml").read_text())
    assert run["memory_growth"] >= 1
    assert (tmp_path / "figure.png").stat().st_size > 1000
