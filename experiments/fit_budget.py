"""What do pixels, samples, starts, tolerance and precision buy in a fit?

GGX facets on a diffuse base, measured with 1 % of noise: as the image of a sphere of 16
to 512 pixels across, and on a goniometer grid of 100 to a million samples. The error is
the root mean square of the relative errors of all parameters, the median of several
draws of the noise. Starts are tried on sharp grooved lobes on a coarse grid, the cases
of `many_starts`, where one start often ends in another minimum; the error there is that
of the widths of the lobe, in the mean over cases. Tolerance is that of the solver, and
its error the distance from the optimum in double precision.
"""

import numpy as np

import brdffit
from benchmarks import ours, problems
from benchmarks.measure import use_one_core
from brdffit import Noise, simulate_measurement
from brdffit.parameters import values
from experiments import many_starts
from experiments.pareto import chart
from experiments.record import RESULTS, Record
from experiments.solvers import LEAST, optimum
from experiments.tradeoff import Variant, measured, rounded, saved

PRECISIONS = ("float64", "float32")
RESOLUTIONS = (16, 32, 64, 128, 256, 512)
SAMPLES = (100, 1_000, 10_000, 100_000, 1_000_000)
STARTS = (1, 4, 16, 64)
TOLERANCES = (1e-2, 1e-5, 1e-7, 1e-10)
MODEL = "ggx"
SHARP, CASES = "ward_duer", 12
DRAWS, TURNS = 5, 3
SEED = many_starts.SEED


def off(result):
    """Root mean square of the relative errors of all parameters."""
    wanted = values(problems.truth(MODEL))
    return np.sqrt(
        np.mean(
            np.concatenate(
                [
                    np.atleast_1d(result.parameters[name] / np.asarray(value) - 1) ** 2
                    for name, value in wanted.items()
                ]
            )
        )
    )


def sized(counts, make, name, draws):
    """Fits of ever more data, in both precisions.

    Args:
        counts: Sizes of the data.
        make: From a size and a seed to a problem of `benchmarks.problems`.
        name: From a size and a problem to what it is called.
        draws: Number of draws of the noise.
    """
    for count in counts:
        drawn = [make(count, seed) for seed in range(draws)]
        for precision in PRECISIONS:

            def run(problem=drawn[0], precision=precision):
                return brdffit.fit(
                    MODEL,
                    problem.samples,
                    residual=problem.residual,
                    starts=4,
                    precision=precision,
                )

            def error(_, run=run, drawn=drawn):
                return float(np.median([off(run(problem)) for problem in drawn]))

            yield Variant(name(count, drawn[0]), run, error, precision)


def started(cases):
    """Fits of sharp lobes from ever more starts."""
    random = np.random.default_rng(SEED)
    known = [many_starts.truth(SHARP, random) for _ in range(cases)]
    data = [
        simulate_measurement(
            brdf, many_starts.GRID, Noise(many_starts.NOISE, seed=SEED + case)
        )
        for case, brdf in enumerate(known)
    ]
    for starts in STARTS:

        def run(starts=starts):
            return [
                brdffit.fit(SHARP, d, residual="plain", starts=starts) for d in data
            ]

        name = f"{starts} start{'s' * (starts > 1)}"
        yield Variant(name, run, widths_off(known), "starts")


def widths_off(known):
    """Mean error of the widths of lobes, as a factor less 1."""

    def error(results):
        ratios = [
            np.log(float(result.parameters[name]) / float(values(brdf)[name]))
            for result, brdf in zip(results, known, strict=True)
            for name in ("alpha_x", "alpha_y")
        ]
        return float(np.expm1(np.mean(np.abs(ratios))))

    return error


def tolerated(problem):
    """The solver alone, by its tolerance."""
    best = optimum(problem)
    for precision in PRECISIONS:
        for tolerance in TOLERANCES:
            solver = ours.solve_alone(problem, precision, rtol=tolerance)
            yield Variant(
                f"{tolerance:g}",
                lambda s=solver: s.solve(0)[0],
                lambda x: max(float(np.max(np.abs(x - best))), LEAST),
                precision,
            )


def gain(rows, question, family=PRECISIONS[0]):
    """From the first to the last of a family: factors of time and of error."""
    own = [r for r in rows if r["question"] == question and r["family"] == family]
    own = own or [r for r in rows if r["question"] == question]
    first, last = own[0], own[-1]
    more = last["seconds"] / first["seconds"]
    return first["variant"], last["variant"], more, first["error"] / last["error"]


def title(rows, question):
    """What one question found."""
    first, last, more, less = gain(rows, question)
    return (
        f"{question}, {first} to {last}: {rounded(more)} times\nthe time, "
        f"1/{rounded(less)} of the error"
    )


def finding(rows):
    """What single precision costs and what samples buy, as a sentence."""
    double, single = (
        [r for r in rows if r["question"] == "resolution" and r["family"] == p][-1]
        for p in (PRECISIONS[0], PRECISIONS[-1])
    )
    _, _, more, less = gain(rows, "samples")
    return (
        f"From the fewest samples to the most, {rounded(more)} times the time buys "
        f"1/{rounded(less)} of the error; float32 {saved(single, double)} at "
        f"{double['variant']} and changes the error by "
        f"{100 * (single['error'] / double['error'] - 1):+.1g} %"
    )


def main(
    folder=RESULTS / "fit_budget",
    resolutions=RESOLUTIONS,
    samples=SAMPLES,
    cases=CASES,
    draws=DRAWS,
    turns=TURNS,
    resolution=64,
):
    """Write table and figure."""
    record, rows = Record(folder, SEED), []
    rows += measured(
        "resolution",
        list(
            sized(
                resolutions,
                lambda n, seed: problems.sphere(MODEL, 1, n, seed),
                lambda n, _: f"{n} px",
                draws,
            )
        ),
        turns,
    )
    rows += measured(
        "samples",
        list(
            sized(
                samples,
                lambda n, seed: problems.goniometer(MODEL, n, seed),
                lambda _, problem: f"{len(problem.samples):,}",
                draws,
            )
        ),
        turns,
    )
    rows += measured("starts", list(started(cases)), turns, share=1 / cases)
    problem = problems.sphere(MODEL, 1, resolution)
    rows += measured("tolerance", list(tolerated(problem)), turns)
    record.table(rows)
    questions = dict.fromkeys(row["question"] for row in rows)
    figure = chart(
        rows,
        {question: title(rows, question) for question in questions},
        finding(rows),
        unit="ms",
        error="error of parameters",
        time_of="one fit",
        columns=2,
        panel=(4.3, 3.3),
    )
    record.figure(figure)
    record.close(finding=finding(rows) + ".", draws=draws, cases=cases, turns=turns)


if __name__ == "__main__":
    use_one_core()
    main()
