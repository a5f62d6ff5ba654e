"""How long does it take to fit a model to a goniometer table by its logarithm?

About 100,000 pairs of directions in three channels with noise of 1 %. The logarithm
lets no parameter be eliminated, so the engine takes its general path.
"""

from benchmarks.field import recorded, timed
from benchmarks.measure import use_one_core
from benchmarks.problems import SEED, goniometer
from benchmarks.record import RESULTS
from experiments.record import Record

SAMPLES, TURNS = 100_000, 7


def main(folder=RESULTS / "gonio_fit", samples=SAMPLES, turns=TURNS, model="ggx"):
    """Time all contestants."""
    record = Record(folder, SEED)
    problem = goniometer(model, samples)
    case = {"model": model, "samples": len(problem.samples)}
    return recorded(record, case, timed(problem, case, turns), turns)


if __name__ == "__main__":
    use_one_core()
    main()
