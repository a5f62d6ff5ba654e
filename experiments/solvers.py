"""How fast does each solver come close, from the same start on the same data?

A sphere with GGX facets under one light and a goniometer table of the same material,
both with 1 % of noise, fitted by brdffit's solver and by plain ones to the same
compiled residual vector. The points of a line are answers to ever tighter tolerances,
of brdffit and Adam after ever more steps; the error is the largest distance of a
parameter from the optimum in double precision, of widths in their logarithm.

The third panel has Mitsuba 3, which renders a sphere of rough plastic, differentiates
that and descends by Adam, and brdffit.fit on the same material, each on the image that
it makes itself, without noise; there the error is the largest relative distance from
the truth. Without LLVM it is left out (see `benchmarks.mitsuba_adam`).
"""

import numpy as np

import brdffit
from benchmarks import mitsuba_adam, ours, plain, problems
from benchmarks.measure import use_one_core
from brdffit.fit.search import RTOL
from brdffit.render.noise import NOISELESS
from experiments.pareto import chart
from experiments.record import RESULTS, Record
from experiments.tradeoff import Variant, front, measured, rounded

RESOLUTION, SAMPLES = 64, 4_000
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8)
STEPS = (2, 4, 6, 10, 20)  # of brdffit
DESCENT = (10, 30, 100, 300)  # steps of Adam
RATES = (0.02, 0.1)
SHOWN = (1, 3, 10, 30, 60, 100, 200)  # steps of Mitsuba
LEAST = 1e-12  # rounding of the optimum itself
CLOSE = 1e-3
PANEL = 4.6, 4.3  # inches
TURNS = 5


def optimum(problem):
    """Where the cost is least, to the last digits that double precision tells."""
    x, _ = plain.scipy_lm(problem, analytic=True).solve(1e-15)
    return x


def variants(problem):
    """Every solver at every tolerance or number of steps."""
    best = optimum(problem)

    def error(x):
        return max(float(np.max(np.abs(x - best))), LEAST)

    for precision in RTOL:
        for steps in STEPS:
            solver = ours.solve_alone(problem, precision, steps)
            yield Variant(
                f"{steps} steps", lambda s=solver: s.solve(0)[0], error, solver.name
            )
    others = [plain.optimistix(problem, name) for name in plain.SOLVERS]
    others += [plain.bfgs(problem)]
    others += [plain.scipy_lm(problem, analytic) for analytic in (True, False)]
    for solver in others:
        for tolerance in TOLERANCES:
            yield Variant(
                f"tolerance {tolerance:g}",
                lambda s=solver, t=tolerance: s.solve(t)[0],
                error,
                solver.name,
            )
    for rate in RATES:
        solver = plain.adam(problem, rate, DESCENT)
        for steps in DESCENT:
            yield Variant(
                f"{steps} steps",
                lambda s=solver, n=steps: s.solve(1 / n)[0],
                error,
                solver.name,
            )


def mitsuba(turns):
    """Lines of rough plastic: brdffit.fit by steps, Mitsuba as it goes."""
    start, image = mitsuba_adam.problem(NOISELESS)
    held = {"eta": mitsuba_adam.ETA}
    fits = [
        Variant(
            f"{steps} steps",
            lambda n=steps: brdffit.fit(
                start, image, starts=1, fixed=held, max_steps=n
            ),
            lambda result: max(mitsuba_adam.off(result), LEAST),
            "brdffit.fit float64",
        )
        for steps in STEPS
    ]
    rows = measured("rough plastic", fits, turns)
    found = mitsuba_adam.searched()
    for rate in mitsuba_adam.RATES:
        paths = [run["path"] for run in found if run["rate"] == rate]
        for step in SHOWN:
            if not paths or step > min(len(path) for path in paths):
                break
            seconds = [path[step - 1][0] for path in paths]
            rows.append(
                rows[0]
                | {
                    "variant": f"{step} steps",
                    "family": f"Mitsuba, Adam, rate {rate:g}",
                    "error": float(np.median([path[step - 1][1] for path in paths])),
                    "seconds": float(np.median(seconds)),
                    "lower_quartile": min(seconds),
                    "upper_quartile": max(seconds),
                    "compile_seconds": 0.0,
                }
            )
    best = front(rows)
    return [row | {"on_front": row in best} for row in rows]


def first_close(rows, question):
    """Least seconds in which every family comes close, the fastest first."""
    own = [r for r in rows if r["question"] == question and r["error"] <= CLOSE]
    found = {}
    for row in sorted(own, key=lambda row: row["seconds"]):
        found.setdefault(row["family"], row["seconds"])
    return found


def race(rows, question):
    """Seconds of brdffit until it is close, and who of the others is, and when.

    Where no other comes close it is the one that comes closest, with its error.
    """
    found = first_close(rows, question)
    mine = [s for name, s in found.items() if name.startswith("brdffit")]
    others = [r for r in rows if r["question"] == question]
    others = [r for r in others if not r["family"].startswith("brdffit")]
    if not mine or not others:
        return None
    close = [r for r in others if r["error"] <= CLOSE]
    if close:
        best = min(close, key=lambda row: row["seconds"])
        within = CLOSE
    else:
        best = min(others, key=lambda row: row["error"])
        within = best["error"]
    name = best["family"].partition(",")[0].removeprefix("optimistix ")
    return min(mine), name, best["seconds"], within


def title(rows, question):
    """Who comes close, and when."""
    if (found := race(rows, question)) is None:
        return question
    mine, name, seconds, within = found
    return (
        f"{question}: brdffit is within {CLOSE:g} after\n{rounded(1000 * mine)} ms, "
        f"{name} within {within:.1g} after {rounded(1000 * seconds)} ms"
    )


def finding(rows):
    """How much sooner than the best of the others, as a sentence."""
    said = []
    for question in dict.fromkeys(row["question"] for row in rows):
        if (found := race(rows, question)) is not None:
            mine, name, seconds, within = found
            nearer = "" if within == CLOSE else f" is within {within:.1g}"
            said.append(f"{rounded(seconds / mine)} times sooner than {name}{nearer}")
    return f"brdffit is within {CLOSE:g} of the right parameters " + ", ".join(said)


def label(rows):
    """A row's name beside its point: that of its family, at the last of it."""
    last = {(row["question"], row["family"]): row for row in rows}
    short = {"optimistix ": "", " lm": "", "finite ": ""}

    def name(row):
        if row not in last.values():
            return ""
        text = row["family"]
        for long, instead in short.items():
            text = text.replace(long, instead)
        return text

    return name


def main(
    folder=RESULTS / "solvers",
    resolution=RESOLUTION,
    samples=SAMPLES,
    turns=TURNS,
    with_mitsuba=True,
):
    """Write table and figure."""
    record, rows = Record(folder, problems.SEED), []
    rows += measured(
        "image of a sphere",
        list(variants(problems.sphere("ggx", 1, resolution))),
        turns,
    )
    rows += measured(
        "goniometer table",
        list(variants(problems.goniometer("ggx", samples))),
        turns,
    )
    if with_mitsuba:
        rows += mitsuba(turns)
    record.table(rows)
    questions = dict.fromkeys(row["question"] for row in rows)
    figure = chart(
        rows,
        {question: title(rows, question) for question in questions},
        finding(rows),
        unit="ms",
        error="distance from the right parameters",
        time_of="one solve",
        label=label(rows),
        panel=PANEL,
    )
    record.figure(figure)
    record.close(
        finding=finding(rows) + ".",
        resolution=resolution,
        samples=samples,
        turns=turns,
        close=CLOSE,
    )


if __name__ == "__main__":
    use_one_core()
    main()
