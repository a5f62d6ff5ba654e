"""How long does it take to fit a model to a photograph of a lit sphere?

A sphere of 128 x 128 pixels in three channels under one or three lights, with noise of
1 %; every contestant starts at the same point, far from the truth, and must reach the
same optimum. Four models: nothing in brdffit is written for any of them.
"""

from benchmarks import ceres, plain
from benchmarks.chart import bars
from benchmarks.measure import contest, row, use_one_core
from benchmarks.ours import solve_alone, whole_fit
from benchmarks.problems import SEED, sphere
from benchmarks.record import RESULTS, facts
from experiments.record import Record

CASES = (
    ("ggx", 1),
    ("ggx", 3),
    ("ward_duer", 1),
    ("oren_nayar", 1),
    ("cook_torrance", 3),
)
TURNS = 21


def contestants(problem):
    """All who can solve it."""
    found = [
        solve_alone(problem, "float32"),
        solve_alone(problem, "float64"),
        whole_fit(problem, "float32"),
        whole_fit(problem, "float64"),
        whole_fit(problem, "float64", starts=16),
        plain.optimistix(problem, "LM"),
        plain.optimistix(problem, "Dogleg"),
        plain.scipy_lm(problem, analytic=True),
        plain.scipy_lm(problem, analytic=False),
    ]
    if ceres.why_absent():
        print(ceres.why_absent())
        return found
    return [
        *found,
        ceres.contestant(problem),
        ceres.contestant(problem, threads=2),
        ceres.contestant(problem, automatic=True),
    ]


def main(folder=RESULTS / "sphere_fit", cases=CASES, turns=TURNS, resolution=128):
    """Time all cases."""
    record = Record(folder, SEED)
    rows = []
    for model, lights in cases:
        problem = sphere(model, lights, resolution)
        entries = contest(contestants(problem), problem.cost, turns)
        ours = dict(zip(("float32", "float64"), entries[:2], strict=True))
        case = {"model": model, "lights": lights, "samples": len(problem.samples)}
        rows += [case | row(entry, ours) for entry in entries]
        print(f"{model} with {lights} light(s) done", flush=True)
    record.table(rows)
    record.figure(bars(rows, ("model", "lights")))
    record.close(**facts(turns))
    return rows


if __name__ == "__main__":
    use_one_core()
    main()
