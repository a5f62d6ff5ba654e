"""The same tasks by threads; what goes wrong in one stops the others."""

import threading
import time

import pytest

from brdffit.batch import cluster
from brdffit.batch.cluster import outcomes


def test_every_item_is_done_once():
    found = list(outcomes(lambda item: item**2, range(50)))
    assert sorted(found) == [item**2 for item in range(50)]


def test_tasks_run_at_the_same_time(monkeypatch):
    monkeypatch.setattr(cluster, "cores", lambda: 2)
    both = threading.Barrier(2)  # which one thread alone would never pass
    list(outcomes(lambda _: both.wait(timeout=20), range(2)))


def test_items_are_taken_up_only_when_somebody_is_free(monkeypatch):
    monkeypatch.setattr(cluster, "cores", lambda: 1)
    taken = []
    stream = outcomes(lambda item: item, (taken.append(i) or i for i in range(10**9)))
    assert next(stream) == 0
    stream.close()
    time.sleep(0.1)
    count = len(taken)
    time.sleep(0.1)
    assert len(taken) == count


def test_an_error_is_raised_and_nothing_runs_on():
    begun = []

    def task(item):
        begun.append(item)
        if item == 3:
            raise OSError("No space left on device")
        time.sleep(0.01)
        return item

    with pytest.raises(OSError, match="No space"):
        list(outcomes(task, range(1000)))
    count = len(begun)
    assert count < 20
    time.sleep(0.1)
    assert len(begun) == count


def test_an_address_without_a_scheduler_is_told_in_a_sentence(monkeypatch):
    monkeypatch.setattr(cluster, "TIMEOUT", 1)
    with pytest.raises(ConnectionError, match=r"no Dask scheduler at `tcp://127"):
        list(outcomes(str, [1], "tcp://127.0.0.1:9"))
