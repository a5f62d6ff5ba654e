"""The field: everyone who solves a problem, and the lines of a table they leave."""

from benchmarks import ceres, plain
from benchmarks.chart import dots
from benchmarks.measure import Contestant, contest, row
from benchmarks.ours import solve_alone, whole_fit
from benchmarks.problems import Problem
from benchmarks.record import facts
from experiments.record import Record


def field(problem: Problem) -> list[Contestant]:
    """All contestants; the first two are brdffit's solve in both precisions."""
    return [
        solve_alone(problem, "float32"),
        solve_alone(problem, "float64"),
        whole_fit(problem, "float32"),
        whole_fit(problem, "float64"),
        whole_fit(problem, "float64", starts=16),
        plain.optimistix(problem, "LM"),
        plain.optimistix(problem, "Dogleg"),
        plain.scipy_lm(problem, analytic=True),
        plain.scipy_lm(problem, analytic=False),
        *ceres.contestants(problem),
    ]


def timed(problem: Problem, case: dict, turns: int, contestants=None) -> list[dict]:
    """Lines of a table, each beginning with what tells the case apart.

    All are compared with the first two contestants, which solve in single and in double
    precision.
    """
    entries = contest(contestants or field(problem), problem.cost, turns)
    ours = dict(zip(("float32", "float64"), entries[:2], strict=True))
    return [case | row(entry, ours) for entry in entries]


def recorded(record: Record, case: dict, rows: list[dict], turns: int) -> list[dict]:
    """The lines of one case, after table, figure and facts were written."""
    record.table(rows)
    record.figure(dots(rows, tuple(case)))
    record.close(**facts(turns))
    return rows
