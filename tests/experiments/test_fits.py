"""Small versions of the experiments on whole fits."""

import jax
import numpy as np
import pytest

from experiments import coverage, many_starts, recovery


@pytest.fixture(autouse=True)
def as_a_script():
    """Only the package must spell out every broadcast."""
    with jax.numpy_rank_promotion("allow"):
        yield


def test_intervals_hold_the_truth_about_as_often_as_they_say():
    """Of 100 repetitions 95 are expected; fewer than 87 have a chance of 1 in 1,000."""
    for z in coverage.deviations("oren_nayar", 100).values():
        inside = np.sum(np.abs(z) <= coverage.NORMAL_95)
        assert 87 <= inside
        assert 0.8 < np.std(z) < 1.25


def test_truths_are_recovered():
    row = recovery.row_of("ggx", 10)
    assert row["recovered"] == 1, row["failures"]


def test_one_start_in_the_middle_misses_sharp_lobes_and_the_engine_does_not():
    rows = {row["starts"]: row for row in many_starts.rows_of("ggx", 8)}
    assert rows["16"]["missed"] == 0
    assert rows["16"]["median_cost"] < 0.5 * rows["middle"]["median_cost"]
