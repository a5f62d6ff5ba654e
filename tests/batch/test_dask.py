"""A cluster gives the numbers of one machine, and loses nothing when parts of it die.

The scheduler and its two workers are processes, as on a real cluster.
"""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from distributed import Client

import brdffit
from brdffit.batch.cluster import outcomes
from tests.batch.wall import CHUNK, fit, same, wall

ROOT = Path(__file__).parents[2]
CHUNKS = 30
PATIENCE = 60  # seconds


class Cluster:
    """A scheduler and two workers of one thread each, started when they are needed."""

    def __init__(self, folder):
        self.folder, self.processes = folder, {}

    @property
    def address(self):
        """Address of a scheduler that is alive."""
        if not self.processes or self.processes["scheduler"].poll() is not None:
            self.close()
            self._open()
        return self._client.scheduler.address

    def pids(self):
        """Process of each worker."""
        assert self.address
        return list(self._client.run(os.getpid).values())

    def kill_scheduler(self):
        """Kill it; its workers, who do not know, are to be ended with `close`."""
        self.processes["scheduler"].kill()
        self.processes["scheduler"].wait()

    def close(self):
        """End everything."""
        if self.processes:
            with contextlib.suppress(Exception):  # there may be nothing to close
                self._client.close(timeout=1)
        for process in reversed(self.processes.values()):
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
        self.processes = {}

    def _open(self):
        file = self.folder / "scheduler.json"
        file.unlink(missing_ok=True)
        words = {
            "scheduler": ("scheduler", "--port", "0", "--host", "127.0.0.1"),
            "workers": ("worker", "--nworkers", "2", "--nthreads", "1")
            + ("--memory-limit", "0", "--local-directory", self.folder),
        }
        for name, (kind, *options) in words.items():
            command = ["-m", f"distributed.cli.dask_{kind}", *options]
            command += ["--scheduler-file", file, "--no-dashboard"]
            self.processes[name] = subprocess.Popen(
                [sys.executable, *map(str, command)],
                cwd=ROOT,
                env=os.environ | {"BRDFFIT_CACHE": str(self.folder / "programs")},
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        end = time.monotonic() + PATIENCE
        while not file.exists():
            assert time.monotonic() < end
            time.sleep(0.05)
        self._client = Client(scheduler_file=str(file), set_as_default=False)
        self._client.wait_for_workers(2, timeout=PATIENCE)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    cluster = Cluster(tmp_path_factory.mktemp("cluster"))
    yield cluster
    cluster.close()


@pytest.fixture(scope="module")
def stack(tmp_path_factory):
    return wall(tmp_path_factory.mktemp("stack") / "wall.zarr", CHUNKS)


@pytest.fixture(scope="module")
def undisturbed(stack, tmp_path_factory):
    out = tmp_path_factory.mktemp("run") / "out"
    fit(stack, out)
    return out


def inverse(number):
    return 1 / number


def test_a_worker_killed_in_mid_run_changes_nothing(
    cluster, stack, undisturbed, tmp_path
):
    address, killed = cluster.address, []

    def kill(tally):
        if not killed and tally.done >= 4 * CHUNK:
            killed.append(cluster.pids()[0])
            os.kill(killed[0], signal.SIGKILL)

    tally = fit(stack, tmp_path / "out", cluster=address, on_progress=kill)
    assert killed
    assert tally.done == CHUNKS * CHUNK
    same(tmp_path / "out", undisturbed)


def test_files_are_fitted_on_a_cluster_and_failures_come_back(
    cluster, tables, tmp_path
):
    files = [tables / "chalk.csv", tmp_path / "absent.csv"]
    there = brdffit.batch(
        files, ["lambert"], tmp_path / "there", starts=2, cluster=cluster.address
    )
    here = brdffit.batch(files, ["lambert"], tmp_path / "here", starts=2)
    for row, same_row in zip(there.rows, here.rows, strict=True):
        row.pop("seconds", None)
        same_row.pop("seconds", None)
        assert row == same_row
    assert [bool(row["failure"]) for row in there.rows] == [False, True]


def test_a_scheduler_is_given_few_tasks_at_a_time(cluster):
    taken = []
    items = (taken.append(item) or item for item in range(1000))
    stream = outcomes(abs, items, cluster.address)
    assert next(stream) in range(10)
    assert len(taken) < 20
    stream.close()


def test_an_error_of_a_task_comes_back(cluster):
    with pytest.raises(ZeroDivisionError):
        list(outcomes(inverse, [1, 0], cluster.address))


def test_a_scheduler_that_goes_away_is_told_and_the_rest_is_done_without(
    cluster, stack, undisturbed, tmp_path
):
    address, out = cluster.address, tmp_path / "out"

    def kill(tally):
        if tally.done >= 5 * CHUNK:
            cluster.kill_scheduler()

    with pytest.raises(ConnectionError, match="went away") as stop:
        fit(stack, out, cluster=address, on_progress=kill)
    assert "go on with --resume" in str(stop.value)
    tally = fit(stack, out, resume=True)
    assert tally.kept >= 5 * CHUNK
    assert tally.kept + tally.done == CHUNKS * CHUNK
    same(out, undisturbed)
