"""The verdict in words: which model explains the data, by how much, what to doubt."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from brdffit.fit import FitResult
from brdffit.fit.examine import POOR
from brdffit.fit.select import TIE, Comparison
from brdffit.report.yardstick import Yardstick

FEW = 0.25  # share of starts below which another, better minimum may have been missed
MANY = 0.05  # share of values left out that a reader should know of
SMALL = 0.05  # share that is missing from all, of which digits are told
NAMED = 3  # most models that a headline names
CLOSE = 1.1  # ratio of errors below which a lead is narrow
TENTHS = 9.95  # ratio of errors up to which tenths are told
OVERWHELMING = 1000  # ratio of errors beyond which digits say nothing
UNLIKELY = 1e-3  # probability of chi-square below which errors and model disagree


class Verdict(NamedTuple):
    """What a reader takes away; names of models stand between backticks.

    Attributes:
        headline: One short sentence.
        sentences: By how much, and what that number is.
        doubts: What to beware of, a sentence each.
        numbers: Key numbers as pairs of label and value.
    """

    headline: str
    sentences: list[str]
    doubts: list[str]
    numbers: list[tuple[str, str]]


def verdict_on_fit(result: FitResult, yardstick: Yardstick) -> Verdict:
    """The verdict on a single fit."""
    error = yardstick.percent(result.rms[result.residual])
    if result.converged:
        headline = f"`{result.model}` is off by {error}"
    else:
        headline = f"The fit of `{result.model}` did not converge"
    sentences = [f"This is the {yardstick.meaning}, over {result.count:,} values."]
    numbers = [("error", error)]
    if result.explained is not None:
        share = _share(result.explained)
        sentences.append(f"The model explains {share} of the variation of the data.")
        numbers.append(("variation explained", share))
    return Verdict(
        headline, sentences, doubts(result), [*numbers, *_effort(result, [result])]
    )


def verdict_on_comparison(
    comparison: Comparison, yardstick: Yardstick, unit: str
) -> Verdict:
    """The verdict on a ranking.

    Args:
        comparison: The ranking.
        yardstick: What makes a percentage of its errors.
        unit: What was held out, in the plural.
    """
    ranked = dict(zip(comparison.results, comparison.entries, strict=True))
    (model, best), *others = ranked.items()
    error = yardstick.percent(best.held_out)
    tied = [model, *(name for name, entry in others if entry.tied)]
    beaten = next(((n, entry) for n, entry in others if not entry.tied), None)
    sentences = [
        f"On {comparison.held_out_count:,} {unit} that no fit had seen, `{model}` is "
        f"off by {error} ({yardstick.meaning})."
    ]
    numbers = [("held-out error", error)]
    headline = f"`{model}` {'fits best' if others else f'is off by {error}'}"
    if beaten is not None and beaten[1].held_out < CLOSE * best.held_out:
        headline += ", narrowly"
    if len(tied) > 1:
        named = listed([f"`{name}`" for name in tied])
        headline = f"{named if len(tied) <= NAMED else f'{len(tied)} models'} tie"
        sizes = {name: free_numbers(ranked[name].result) for name in tied}
        simplest = min(sizes, key=lambda name: sizes[name])
        sentences.append(
            f"The others' errors differ from that by less than {TIE:g} standard "
            "errors of the difference, so these data do not tell them apart; "
            f"`{simplest}` needs the fewest numbers, {sizes[simplest]}."
        )
        numbers.append(("models that tie", str(len(tied))))
    if beaten is not None:
        name, entry = beaten
        lead = yardstick.percent(entry.held_out)
        behind = "The next model is" if len(tied) == 1 else "Clearly behind comes"
        times = _times(entry.held_out, best.held_out)
        sentences.append(f"{behind} `{name}`, off by {lead}: {times}.")
        numbers.append((f"next: {name}", lead))
    return Verdict(
        headline,
        sentences,
        doubts(best.result) + _unfinished(comparison.results, model),
        [*numbers, *_effort(best.result, list(comparison.results.values()))],
    )


def doubts(result: FitResult) -> list[str]:
    """What to beware of in a fit, a sentence each."""
    found = unsure(result)
    if not result.converged:
        found.append(result.status)
    if result.explained is not None and result.explained < POOR:
        share = _share(max(result.explained, 0.0))
        found.append(f"`{result.model}` explains only {share} of the variation.")
    agreeing = round(result.agreement * result.starts)
    if result.starts > 1 and result.agreement < FEW:
        found.append(
            f"Only {agreeing} of {result.starts} starts ended in the best minimum: "
            "more starts may find a better one."
        )
    if result.p_value is not None and result.p_value < UNLIKELY:
        found.append(
            f"The errors given with the data are too small for `{result.model}`: "
            f"chi-square is {result.chi_square:.4g} for {result.count:,} values, and a "
            f"larger one has probability {result.p_value:.1g}."
        )
    total = result.count + result.masked
    if result.masked > MANY * total:
        found.append(
            f"{result.masked:,} of {total:,} values ({_share(result.masked / total)}) "
            f"were left out of the fit."
        )
    return found


def unsure(result: FitResult) -> list[str]:
    """What is at a bound and what the data cannot tell, each sentence once."""
    sentences = [*result.at_bound.values(), *result.undetermined.values()]
    return list(dict.fromkeys(sentences))


def listed(words: list[str]) -> str:
    """``a, b and c``."""
    return ", ".join(words[:-1]) + " and " + words[-1] if len(words) > 1 else words[0]


def free_numbers(result: FitResult) -> int:
    """How many numbers a fit was free to choose."""
    return len(result.labels) - len(result.held)


def _unfinished(results: Mapping[str, FitResult], best: str) -> list[str]:
    """What to beware of in the others, of which ``best`` is none."""
    names = [f"`{n}`" for n, r in results.items() if n != best and not r.converged]
    if not names:
        return []
    fits = "fits" if len(names) > 1 else "fit"
    return [
        f"The {fits} of {listed(names)} did not converge, so the ranking may do wrong "
        "to them."
    ]


def _effort(result: FitResult, all_results: list[FitResult]) -> list[tuple[str, str]]:
    agreeing = round(result.agreement * result.starts)
    seconds = sum(each.seconds for each in all_results)
    return [
        ("free numbers", str(free_numbers(result))),
        ("starts that agree", f"{agreeing} of {result.starts}"),
        ("time of the fits" if len(all_results) > 1 else "time", f"{seconds:.1f} s"),
    ]


def _share(share: float) -> str:
    """A share in percent; one near 100 keeps what it lacks."""
    lack = 1 - share
    digits = min(-math.floor(math.log10(100 * lack)), 4) if 0 < lack < SMALL else 0
    return f"{100 * share:.{max(digits, 0)}f}\N{NO-BREAK SPACE}%"


def _times(error: float, least: float) -> str:
    """How many times as large an error is."""
    ratio = error / least if least > 0 else math.inf
    if ratio > OVERWHELMING:
        return f"more than {OVERWHELMING:,} times as much"
    if ratio < CLOSE:
        return f"{100 * (ratio - 1):.1g}\N{NO-BREAK SPACE}% more"
    return f"{ratio:.{1 if ratio < TENTHS else 0}f} times as much"
