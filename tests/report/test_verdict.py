import dataclasses

import pytest

from brdffit import MODELS
from brdffit.fit import RESIDUALS
from brdffit.report.verdict import (
    doubts,
    listed,
    verdict_on_comparison,
    verdict_on_fit,
)
from brdffit.report.yardstick import Yardstick
from tests.results import comparison_of, result_of

LOG = Yardstick(RESIDUALS["log"], 2.0)
PLAIN = Yardstick(RESIDUALS["plain"], 2.0)
BRDFS = [MODELS[name]() for name in ("ggx", "phong", "lambert", "oren_nayar", "eon")]


@pytest.mark.parametrize(
    ("measure", "rms", "shown"),
    [
        (LOG, 0.1, "11"),
        (LOG, 0.0198, "2.0"),
        (LOG, 2.0, "639"),
        (PLAIN, 0.1, "5.0"),
        (PLAIN, 1e-6, "<\N{NARROW NO-BREAK SPACE}0.001"),
    ],
)
def test_errors_are_percentages(measure, rms, shown):
    assert measure.percent(rms) == f"{shown}\N{NO-BREAK SPACE}%"


def test_the_winner_leads_by_a_factor():
    verdict = verdict_on_comparison(comparison_of(*BRDFS), PLAIN, "pixels")
    assert verdict.headline == "`ggx` fits best"
    assert (
        "On 20 pixels that no fit had seen, `ggx` is off by 5.0"
        in (verdict.sentences[0])
    )
    assert verdict.sentences[1].startswith("The next model is `phong`, off by 10")
    assert verdict.sentences[1].endswith(": 2.0 times as much.")
    assert dict(verdict.numbers)["next: phong"].startswith("10")


def test_a_tie_names_the_simplest_and_who_is_clearly_behind():
    ranked = comparison_of(*BRDFS, tied=(1, 2))
    verdict = verdict_on_comparison(ranked, LOG, "directions")
    assert verdict.headline == "`ggx`, `phong` and `lambert` tie"
    assert "less than 2 standard errors" in verdict.sentences[1]
    assert "`lambert` needs the fewest numbers, 3." in verdict.sentences[1]
    assert verdict.sentences[2].startswith("Clearly behind comes `oren_nayar`")
    many = verdict_on_comparison(comparison_of(*BRDFS, tied=(1, 2, 3)), LOG, "pixels")
    assert many.headline == "4 models tie"


def test_an_exact_winner_is_more_than_a_thousand_times_better():
    ranked = comparison_of(*BRDFS[:2])
    exact = dataclasses.replace(ranked.entries[0], held_out=0.0)
    ranked = dataclasses.replace(ranked, entries=(exact, ranked.entries[1]))
    verdict = verdict_on_comparison(ranked, LOG, "pixels")
    assert verdict.sentences[1].endswith("more than 1,000 times as much.")


def test_a_narrow_lead_is_called_so():
    ranked = comparison_of(*BRDFS[:2])
    near = dataclasses.replace(ranked.entries[1], held_out=0.103)
    ranked = dataclasses.replace(ranked, entries=(ranked.entries[0], near))
    verdict = verdict_on_comparison(ranked, LOG, "pixels")
    assert verdict.headline == "`ggx` fits best, narrowly"
    assert verdict.sentences[1].endswith(": 3\N{NO-BREAK SPACE}% more.")


def test_models_of_one_name_are_told_apart():
    ranked = comparison_of(BRDFS[0], BRDFS[0])
    verdict = verdict_on_comparison(ranked, LOG, "pixels")
    assert "The next model is `ggx (2)`" in verdict.sentences[1]


def test_a_fit_that_did_not_converge_is_the_headline():
    result = result_of(BRDFS[0], converged=False, status="It gave up.")
    verdict = verdict_on_fit(result, LOG)
    assert verdict.headline == "The fit of `ggx` did not converge"
    assert "It gave up." in verdict.doubts


def test_nothing_to_doubt_is_nothing_said():
    assert doubts(result_of(BRDFS[0])) == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"at_bound": {"alpha": "`alpha` is at its upper bound 1."}}, "upper bound 1"),
        ({"undetermined": {"a": "Same.", "b": "Same."}}, "Same."),
        ({"explained": 0.2}, "explains only 20"),
        ({"agreement": 0.125}, "Only 2 of 16 starts"),
        ({"masked": 25}, "25 of 125 values (20"),
        ({"p_value": 1e-9, "chi_square": 500.0}, "probability 1e-09"),
    ],
)
def test_each_doubt_is_one_sentence(changes, said):
    (sentence,) = doubts(result_of(BRDFS[0], **changes))
    assert said in sentence


def test_lists_end_with_and():
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"
