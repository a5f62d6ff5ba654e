"""The benchmark of a cluster in a tiny size, on clusters within this process."""

import csv
import tomllib

import pytest
from distributed import LocalCluster

from benchmarks import cluster


def test_workers_chunks_and_the_scheduler_are_measured(tmp_path, monkeypatch):
    def workers(count, threads=1):
        return LocalCluster(
            n_workers=count,
            threads_per_worker=threads,
            processes=False,
            dashboard_address=":0",
        )

    monkeypatch.setenv("BRDFFIT_CACHE", "off")
    monkeypatch.setattr(cluster, "workers", workers)
    monkeypatch.setattr(cluster, "MODEL", "lambert")
    monkeypatch.setattr(cluster, "MAPS", {"albedo": (3, 0.05, 0.6)})
    cluster.main(tmp_path, chunk=64, chunks=2, turns=1, empty=20)
    with open(tmp_path / "table.csv", newline="") as file:
        rows = {row["what"]: float(row["median"]) for row in csv.DictReader(file)}
    assert rows["a chunk by one worker"] >= rows["fit"] > 0
    assert {"1 worker", "2 workers", "read", "ledger", "empty tasks"} <= set(rows)
    ratio = rows["2 workers"] / rows["1 worker"]
    assert rows["two workers over one"] == pytest.approx(ratio, rel=1e-3)
    assert tomllib.loads((tmp_path / "run.toml").read_text())["chunk"] == 64
    assert (tmp_path / "figure.png").stat().st_size > 1000
