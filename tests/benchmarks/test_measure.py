"""A contest must see wrong answers, forgive none, and compare turn by turn."""

import numpy as np
import pytest

from benchmarks.measure import Contestant, Entry, check, contest, ratios, row


def answering(name, error, **options):
    """A contestant that ends a multiple of its tolerance away from the optimum at 0."""
    return Contestant(
        name, lambda tolerance: (np.array([error * tolerance]), 1), **options
    )


def cost(x):
    return 1 + float(x @ x)


def test_the_loosest_tolerance_that_is_right_is_chosen():
    exact, rough = check([answering("exact", 0.1), answering("rough", 20.0)], cost)
    assert exact.tolerance == 1e-4  # 1e-10 above the lowest cost
    assert rough.tolerance == 1e-5  # 4e-6 at 1e-4, 4e-8 at 1e-5
    assert exact.right
    assert rough.right


def test_a_wrong_answer_gets_no_ratio():
    good, bad = contest([answering("good", 0.0), answering("bad", 1e12)], cost, 1)
    assert not bad.right
    line = row(bad, {"float32": good})
    assert line["answer"] == "wrong"
    assert line["over_float32"] == line["quartiles_float32"] == ""
    assert row(good, {"float32": good})["over_float32"] == "1.00"


def test_an_answer_that_is_no_number_is_wrong():
    good, none = check([answering("good", 0.0), answering("none", np.nan)], cost)
    assert good.right
    assert not none.right


def test_ratios_compare_within_a_turn():
    slow, fast = (
        Entry(answering(name, 0.0), 1e-4, 1, 0.0, 0.0, seconds=times)
        for name, times in (("slow", [2.0, 20.0, 8.0]), ("fast", [1.0, 10.0, 2.0]))
    )
    assert ratios(slow, fast) == pytest.approx((2, 2, 3))


def test_threads_are_compared_on_the_wall():
    one = Entry(answering("one", 0.0), 1e-4, 1, 0.0, 0.0, [1.0], [3.0])
    two = Entry(answering("two", 0.0, threads=2), 1e-4, 1, 0.0, 0.0, [6.0], [6.0])
    assert ratios(two, one)[1] == pytest.approx(2)
