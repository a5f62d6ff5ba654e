"""What do 64 starts cost, in single fits?

The sphere of `sphere_fit` under one light, fitted by `brdffit.fit` from one start and
from many. Of the peers none sorts starts out: many starts cost them as many fits.
"""

from benchmarks import plain
from benchmarks.chart import dots
from benchmarks.field import timed
from benchmarks.measure import use_one_core
from benchmarks.ours import whole_fit
from benchmarks.problems import SEED, sphere
from benchmarks.record import RESULTS, facts
from experiments.record import Record

MODELS, STARTS, TURNS = ("ggx", "ward_duer"), 64, 7


def main(folder=RESULTS / "many_starts", models=MODELS, turns=TURNS, resolution=128):
    """Time both; a ratio is in single fits of the same precision."""
    record = Record(folder, SEED)
    rows = []
    for model in models:
        problem = sphere(model, 1, resolution)
        contestants = [
            whole_fit(problem, "float32"),
            whole_fit(problem, "float64"),
            whole_fit(problem, "float32", STARTS),
            whole_fit(problem, "float64", STARTS),
            plain.optimistix(problem, "LM"),
            plain.scipy_lm(problem, analytic=True),
        ]
        case = {"model": model, "samples": len(problem.samples)}
        rows += timed(problem, case, turns, contestants)
    record.table(rows)
    record.figure(dots(rows, ("model",)))
    record.close(**facts(turns))
    return rows


if __name__ == "__main__":
    use_one_core()
    main()
