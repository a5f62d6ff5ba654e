"""Rates and times left count the work of this run only."""

import time

import pytest

from brdffit.batch import Tally


@pytest.fixture
def clock(monkeypatch):
    """A clock that goes only when told to."""
    now = [100.0]
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])
    return now


def test_what_was_kept_makes_no_run_faster(clock):
    tally = Tally("texels", 1000)
    assert tally.remaining is None
    clock[0] += 5
    tally.add(600, kept=True, not_converged=6)
    assert (tally.share, tally.rate, tally.remaining) == (0.6, 0.0, None)
    clock[0] += 2
    tally.add(100, kept=False, not_converged=1)
    assert tally.rate == pytest.approx(50)
    assert tally.remaining == pytest.approx(6)
    assert tally.sentence == (
        "700 of 1,000 texels finished; 600 kept from an earlier run; 100 done now, "
        "50 per second; 7 did not converge."
    )


def test_nothing_to_do_is_all_done():
    assert Tally("fits", 0).share == 1
