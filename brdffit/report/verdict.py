"""The verdict in words: which model explains the data, by how much, what to doubt."""

import math
from typing import NamedTuple

from brdffit.fit import FitResult
from brdffit.fit.examine import POOR
from brdffit.fit.select import TIE, Comparison
from brdffit.report.yardstick import Yardstick

FEW = 0.25  # share of starts below which another, better minimum may have been missed
MANY = 0.05  # share of values left out that a reader should know of
SMALL = 0.05  # share that is missing from all, of which digits are told
NAMED = 3  # most models that a headline names
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
    best, *others = comparison.entries
    model, error = best.result.model, yardstick.percent(best.held_out)
    tied = [entry.result.model for entry in comparison.entries if entry.tied]
    beaten = next((entry for entry in others if not entry.tied), None)
    sentences = [
        f"On {comparison.held_out_count:,} {unit} that no fit had seen, it is off "
        f"by {error} ({yardstick.meaning})."
    ]
    numbers = [("held-out error", error)]
    if len(tied) > 1:
        names = listed([f"`{name}`" for name in tied])
        headline = f"{names if len(tied) <= NAMED else f'{len(tied)} models'} tie"
        simplest = min(
            (entry.result for entry in comparison.entries if entry.tied),
            key=lambda result: len(result.labels),
        )
        sentences[0] = sentences[0].replace(" it is off", f" `{model}` is off")
        sentences.append(
            f"The others' errors differ from that by less than {TIE:g} standard "
            "errors of the difference, so these data do not tell them apart; "
            f"`{simplest.model}` needs the fewest numbers, {len(simplest.labels)}."
        )
        numbers.append(("models that tie", str(len(tied))))
    elif others:
        headline = f"`{model}` fits best"
    else:
        headline = f"`{model}` is off by {error}"
    if beaten is not None:
        times = _times(beaten.held_out / best.held_out)
        lead = yardstick.percent(beaten.held_out)
        behind = "The next model is" if len(tied) == 1 else "Clearly behind comes"
        sentences.append(
            f"{behind} `{beaten.result.model}`, off by {lead}: {times} as much."
        )
        numbers.append((f"next: {beaten.result.model}", lead))
    results = [entry.result for entry in comparison.entries]
    return Verdict(
        headline,
        sentences,
        doubts(best.result) + _unfinished(results[1:]),
        [*numbers, *_effort(best.result, results)],
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


def _unfinished(results: list[FitResult]) -> list[str]:
    names = [f"`{result.model}`" for result in results if not result.converged]
    if not names:
        return []
    return [
        f"The {'fits' if len(names) > 1 else 'fit'} of {listed(names)} did not "
        "converge, so the ranking may do wrong to them."
    ]


def _effort(result: FitResult, all_results: list[FitResult]) -> list[tuple[str, str]]:
    agreeing = round(result.agreement * result.starts)
    seconds = sum(each.seconds for each in all_results)
    return [
        ("free numbers", str(len(result.labels) - len(result.held))),
        ("starts that agree", f"{agreeing} of {result.starts}"),
        ("time of the fits" if len(all_results) > 1 else "time", f"{seconds:.1f} s"),
    ]


def _share(share: float) -> str:
    """A share in percent; one near 100 keeps what it lacks."""
    lack = 1 - share
    digits = min(-math.floor(math.log10(100 * lack)), 4) if 0 < lack < SMALL else 0
    return f"{100 * share:.{max(digits, 0)}f}\N{NO-BREAK SPACE}%"


def _times(ratio: float) -> str:
    if ratio > OVERWHELMING:
        return f"more than {OVERWHELMING:,} times"
    return f"{ratio:.1f} times" if ratio < 9.95 else f"{ratio:.0f} times"
