"""How time is taken: contestants take turns, and only right answers are compared.

Contestants on one thread are charged with the processor time of the process, which the
load of the machine does not change; those on more threads with the time on the wall.
Every turn begins with a call that is not timed, so that no contestant finds its caches
filled with the data of the one before.
"""

import contextlib
import dataclasses
import os
import random
import time
from collections.abc import Callable, Iterator, Sequence

import numpy as np

TOLERANCES = tuple(10.0**-k for k in range(4, 13))
SAME_OPTIMUM = 1e-6  # cost above the lowest of all, as a share of it
TURN = 0.02  # seconds that a turn should at least take
ALL_CORES = os.sched_getaffinity(0)


@dataclasses.dataclass(frozen=True)
class Contestant:
    """Something that solves the problem.

    Attributes:
        name: What it is called in tables and figures.
        solve: From a tolerance to the point where it ended and the steps it took.
        threads: Number of threads it uses.
        tolerances: Tolerances to choose from, the loosest first.
    """

    name: str
    solve: Callable[[float], tuple[np.ndarray, int]]
    threads: int = 1
    tolerances: Sequence[float] = TOLERANCES


@dataclasses.dataclass
class Entry:
    """A contestant after the check of its answer, and the times of its turns.

    Attributes:
        contestant: Who.
        tolerance: The loosest at which the answer is right, or else the tightest.
        steps: Steps taken with it.
        excess: Cost above the lowest, as a share of it.
        first: Seconds of the very first call: tracing and compiling are in it.
        seconds: What a call is charged with, one number for each turn.
        wall: Time of a call on the wall, one number for each turn.
    """

    contestant: Contestant
    tolerance: float
    steps: int
    excess: float
    first: float
    seconds: list[float] = dataclasses.field(default_factory=list)
    wall: list[float] = dataclasses.field(default_factory=list)

    @property
    def right(self) -> bool:
        """Whether it found the optimum."""
        return self.excess <= SAME_OPTIMUM

    def call(self) -> None:
        """Solve once."""
        self.contestant.solve(self.tolerance)


def use_one_core(core: int | None = None) -> None:
    """Keep this process on one core; to be called before JAX runs anything."""
    os.sched_setaffinity(0, {max(ALL_CORES) if core is None else core})


@contextlib.contextmanager
def cores(threads: int) -> Iterator[None]:
    """Let what several threads do inside spread over all cores."""
    before = os.sched_getaffinity(0)
    if threads > 1:
        os.sched_setaffinity(0, ALL_CORES)
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def contest(
    contestants: Sequence[Contestant],
    cost: Callable[[np.ndarray], float],
    turns: int,
) -> list[Entry]:
    """Check every contestant, then time all in turns, each round in another order."""
    entries = check(contestants, cost)
    take_turns(entries, turns)
    return entries


def take_turns(entries: Sequence[Entry], turns: int) -> None:
    """Time all entries in turns, each round in another order."""
    calls = [_calls(entry) for entry in entries]
    order = random.Random(0)
    for _ in range(turns):
        for place in order.sample(range(len(entries)), len(entries)):
            _turn(entries[place], calls[place])


def check(
    contestants: Sequence[Contestant], cost: Callable[[np.ndarray], float]
) -> list[Entry]:
    """Find the loosest tolerance at which each contestant reaches the optimum.

    The optimum is the lowest cost that any reaches at its tightest tolerance.
    """
    first, tightest = {}, {}
    for c in contestants:
        begin = time.perf_counter()
        with cores(c.threads):
            x, steps = c.solve(c.tolerances[-1])
        first[c.name] = time.perf_counter() - begin
        tightest[c.name] = cost(x), steps
    lowest = np.nanmin([found for found, _ in tightest.values()])
    return [_loosest(c, cost, lowest, tightest, first[c.name]) for c in contestants]


def _loosest(contestant, cost, lowest: float, tightest, first: float) -> Entry:
    for tolerance in contestant.tolerances[:-1]:
        with cores(contestant.threads):
            x, steps = contestant.solve(tolerance)
        excess = cost(x) / lowest - 1
        if excess <= SAME_OPTIMUM:
            return Entry(contestant, tolerance, steps, excess, first)
    reached, steps = tightest[contestant.name]
    tolerance = contestant.tolerances[-1]
    return Entry(contestant, tolerance, steps, reached / lowest - 1, first)


def _calls(entry: Entry) -> int:
    """Number of calls that make a turn long enough to be timed."""
    begin = time.perf_counter()
    entry.call()
    return max(1, round(TURN / (time.perf_counter() - begin)))


def _turn(entry: Entry, calls: int) -> None:
    with cores(entry.contestant.threads):
        entry.call()
        wall, used = time.perf_counter(), time.process_time()
        for _ in range(calls):
            entry.call()
        wall, used = time.perf_counter() - wall, time.process_time() - used
    entry.wall.append(wall / calls)
    charged = used if entry.contestant.threads == 1 else wall
    entry.seconds.append(charged / calls)


def ratios(entry: Entry, ours: Entry) -> tuple[float, float, float]:
    """Lower quartile, median and upper quartile of how many times longer it takes.

    Of the two compared turn by turn, on the wall where either uses several threads.
    """
    threads = {entry.contestant.threads, ours.contestant.threads}
    mine, theirs = (
        (ours.seconds, entry.seconds) if threads == {1} else (ours.wall, entry.wall)
    )
    low, middle, high = np.quantile(np.divide(theirs, mine), [0.25, 0.5, 0.75])
    return float(low), float(middle), float(high)


def row(entry: Entry, ours: dict[str, Entry]) -> dict[str, object]:
    """One line of a table; without a ratio where the answer is wrong.

    Args:
        entry: Of whom.
        ours: With whom to compare, by the name that heads the column.
    """
    line = {
        "contestant": entry.contestant.name,
        "threads": entry.contestant.threads,
        "answer": "right" if entry.right else "wrong",
        "excess": f"{entry.excess:.1e}",
        "steps": entry.steps,
        "tolerance": f"{entry.tolerance:.0e}",
        "ms": 1e3 * float(np.median(entry.seconds)),
        "least_ms": 1e3 * min(entry.seconds),
        "most_ms": 1e3 * max(entry.seconds),
        "wall_ms": 1e3 * float(np.median(entry.wall)),
        "first_s": round(entry.first, 2),
    }
    for name, mine in ours.items():
        fair = entry.right and mine.right
        low, middle, high = ratios(entry, mine)
        line[f"over_{name}"] = f"{middle:.2f}" if fair else ""
        line[f"quartiles_{name}"] = f"{low:.2f}-{high:.2f}" if fair else ""
    return line
