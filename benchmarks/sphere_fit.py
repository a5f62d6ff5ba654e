"""How long does it take to fit a model to a photograph of a lit sphere?

A sphere of 128 x 128 pixels in three channels under one or three lights, with noise of
1 %; every contestant starts at the same point, far from the truth, and must reach the
same optimum. Four models: nothing in brdffit is written for any of them.
"""

from benchmarks.chart import dots
from benchmarks.field import timed
from benchmarks.measure import use_one_core
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
TURNS = 11


def main(folder=RESULTS / "sphere_fit", cases=CASES, turns=TURNS, resolution=128):
    """Time all cases."""
    record = Record(folder, SEED)
    rows = []
    for model, lights in cases:
        problem = sphere(model, lights, resolution)
        case = {"model": model, "lights": lights, "samples": len(problem.samples)}
        rows += timed(problem, case, turns)
        print(*case.values(), "done", flush=True)
    record.table(rows)
    record.figure(dots(rows, ("model", "lights")))
    record.close(**facts(turns))
    return rows


if __name__ == "__main__":
    use_one_core()
    main()
