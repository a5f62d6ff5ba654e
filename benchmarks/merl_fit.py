"""How long does it take to fit a model to a whole MERL file?

A file of 1.46 million cells is written from a known model with noise of 1 % and read
back; every cell above the horizon counts, compared by its logarithm.
"""

import tempfile
from pathlib import Path

from benchmarks import ceres, plain
from benchmarks.field import recorded, timed
from benchmarks.measure import use_one_core
from benchmarks.ours import solve_alone, whole_fit
from benchmarks.problems import SEED, merl, write_merl
from benchmarks.record import RESULTS
from experiments.record import Record

TURNS = 3


def field(problem):
    """Those of all contestants that need no minutes for a solve."""
    return [
        solve_alone(problem, "float32"),
        solve_alone(problem, "float64"),
        whole_fit(problem, "float32"),
        whole_fit(problem, "float64"),
        whole_fit(problem, "float64", starts=16),
        plain.optimistix(problem, "LM"),
        plain.scipy_lm(problem, analytic=True),
        *ceres.contestants(problem)[:2],
    ]


def main(folder=RESULTS / "merl_fit", turns=TURNS, model="ggx", every=1):
    """Time the contestants.

    Args:
        folder: Where the results go.
        turns: Turns of each contestant.
        model: What is fitted.
        every: One in so many cells is fitted.
    """
    record = Record(folder, SEED)
    with tempfile.TemporaryDirectory() as temporary:
        file = Path(temporary) / "stand_in.binary"
        write_merl(model, file)
        problem = merl(model, file, every)
    case = {"model": model, "samples": len(problem.samples)}
    return recorded(record, case, timed(problem, case, turns, field(problem)), turns)


if __name__ == "__main__":
    use_one_core()
    main()
