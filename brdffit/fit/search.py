"""From many starts to the best minimum: sort out on few samples, finish on all."""

import dataclasses
from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float, Int

from brdffit.compiled import compiled
from brdffit.fit import structure
from brdffit.fit.basis import Problem
from brdffit.fit.blocks import AHEAD, blocks
from brdffit.fit.start import typical_box
from brdffit.fit.status import CONVERGED
from brdffit.samples import Samples
from brdffit.types import AnyArray

RTOL = {"float64": 1e-10, "float32": 1e-9}
FINALISTS = 3  # minima that are finished on all samples
SAME_BASIN = 1e-3  # relative difference in cost below which two minima are one


class Minima(eqx.Module):
    """Where starts ended, or where one did.

    Attributes:
        x: All parameters in solver coordinates.
        cost: Half the weighted sum of squares.
        rounding: Error of the cost.
        steps: Solver steps taken.
        status: Outcome of each solve, a place in `STATUS`.
    """

    x: Float[AnyArray, "*start n"]
    cost: Float[AnyArray, "*start"]
    rounding: Float[AnyArray, "*start"]
    steps: Int[AnyArray, "*start"]
    status: Int[AnyArray, "*start"]


class Search(eqx.Module):
    """The outcome of a search.

    Attributes:
        x: The best point found.
        cost: What is minimised, there.
        steps: Steps of the solve that found it.
        status: Its outcome, a place in `STATUS`.
        basins: Number of distinct minima met.
        agreement: Share of starts that ended in the best one.
    """

    x: np.ndarray
    cost: float
    steps: int
    status: int
    basins: int
    agreement: float


def search(
    problem: partial[Problem],
    exact: Problem,
    samples: Samples,
    use: Bool[np.ndarray, "sample channel"],
    starts: Float[np.ndarray, "start n"],
    precision: str,
    max_steps: int,
) -> Search:
    """Solve from all starts and return the best minimum.

    With many samples all starts run on the first blocks, which stand for all and tell
    the basins apart, and only the best few are finished on all.

    Args:
        problem: Everything but the samples; called with ``blocks``.
        exact: The same with all samples, in double precision.
        samples: What to explain.
        use: Which values count.
        starts: Starting points in solver coordinates.
        precision: Precision in which models are evaluated.
        max_steps: Steps after which a start gives up.
    """
    rtol = RTOL[precision]
    whole = exact
    if np.dtype(precision) != exact.blocks.wi.dtype:
        residual = problem.keywords["residual"]
        whole = problem(blocks=blocks(samples, use, residual, np.dtype(precision)))
    room = np.zeros((max(len(starts), FINALISTS), starts.shape[1]))
    room[: len(starts)] = starts
    count = len(starts)
    met = None
    if whole.blocks.count > AHEAD and count > 1:
        few = dataclasses.replace(whole.blocks, count=np.asarray(AHEAD, np.int32))
        sample = dataclasses.replace(whole, blocks=few)
        met = solve(sample, room, count, rtol=rtol, max_steps=max_steps)
        finalists = _distinct(met)[:FINALISTS]
        room[: len(finalists)] = met.x[finalists]
        count = max(len(finalists), 1)  # without any, the first start is tried again
    final = solve(whole, room, count, rtol=rtol, max_steps=max_steps)
    return outcome(final if met is None else met, final)


def outcome(met: Minima, final: Minima) -> Search:
    """The best minimum, and how many there are.

    Args:
        met: Where the starts ended.
        final: Where the best of them were finished.
    """
    near = met.cost <= np.nanmin(met.cost) + _same(met)
    best = _best(final)
    return Search(
        x=np.asarray(final.x[best]),
        cost=float(final.cost[best]),
        steps=int(final.steps[best]),
        status=int(final.status[best]),
        basins=len(_distinct(met)),
        agreement=float(np.mean(near)),
    )


def _best(met: Minima) -> int:
    """The lowest minimum; among equals, one whose solve was completed."""
    cost = np.where(np.isfinite(met.cost), met.cost, np.inf)
    worse = cost > np.min(cost) + 4 * met.rounding
    unfinished = met.status != CONVERGED
    return int(np.lexsort((cost, unfinished, worse))[0])


def _same(met: Minima) -> np.ndarray:
    """Difference in cost up to which two minima count as one."""
    return SAME_BASIN * np.abs(met.cost) + 4 * met.rounding


def _distinct(met: Minima) -> np.ndarray:
    """Index of one start per basin, the best first."""
    cost, same = met.cost, _same(met)
    order = np.argsort(cost)
    new = np.ones(len(order), bool)
    new[1:] = cost[order[1:]] > cost[order[:-1]] + same[order[1:]]
    return order[new & np.isfinite(cost[order])]


def _solve(
    problem: Problem, starts: AnyArray, count: AnyArray, rtol: float, max_steps: int
) -> Minima:
    """Solve from the first ``count`` starts, one after the other in one program.

    Each start takes the steps that it needs and no more; batched, all would take those
    of the slowest, and the small matrix products of a batch are slow on a CPU.

    Where linear parameters can be eliminated the solver sees the others alone. Where
    not it sees all, and the linear ones whose start is NaN begin where they fit best
    within their typical range: at a bound, such as a lobe of no height, the others may
    have no effect to begin with.
    """
    # imported late: a program that is kept on disk is never traced again
    import optimistix as optx

    from brdffit.fit.solve import BoundedLevenbergMarquardt, outcome_of

    nonlinear, layout = problem.nonlinear_places, problem.layout
    linear_places = layout.channel_places(layout.linear)
    low, high = (box[linear_places] for box in typical_box(layout))
    projected = problem.projected
    seen = nonlinear if projected else np.arange(starts.shape[1])
    options = {"lower": problem.lower[seen], "upper": problem.upper[seen]}
    solver = BoundedLevenbergMarquardt(rtol)

    def equations(x, problem):
        if projected:
            return structure.project(problem, x)
        return structure.stream(problem, x), jnp.zeros((layout.channels, 0))

    def from_start(x):
        if not projected:
            _, linear = structure.project(problem, x[nonlinear], derivatives=False)
            given = x[linear_places]
            begin = jnp.where(jnp.isnan(given), jnp.clip(linear, low, high), given)
            x = x.at[linear_places].set(begin)
        solution = optx.least_squares(
            equations,
            solver,
            x[seen],
            args=problem,
            options=options,
            has_aux=True,
            max_steps=max_steps,
            throw=False,
        )
        x = x.at[seen].set(solution.value)
        if projected:
            x = x.at[linear_places].set(solution.aux)
        return Minima(
            x=x,
            cost=solution.state.equations.cost,
            rounding=solution.state.equations.rounding,
            steps=solution.stats["num_steps"],
            status=outcome_of(solution.result),
        )

    def one_more(i, met):
        return jax.tree.map(lambda m, new: m.at[i].set(new), met, from_start(starts[i]))

    shapes = jax.eval_shape(from_start, starts[0])
    empty = jax.tree.map(lambda s: jnp.zeros((len(starts), *s.shape), s.dtype), shapes)
    return jax.lax.fori_loop(0, count, one_more, empty)


_compiled_solve = compiled(_solve, static=("rtol", "max_steps"))


def solve(
    problem: Problem, starts: np.ndarray, count: int, rtol: float, max_steps: int
) -> Minima:
    """Where the first ``count`` starts end; the others are room that compiles once.

    Args:
        problem: The fit.
        starts: Starting points in solver coordinates.
        count: How many of them to solve from.
        rtol: Relative decrease of the cost at which to stop.
        max_steps: Steps after which a start gives up.
    """
    asked = np.asarray(count, np.int32)
    met = _compiled_solve(problem, starts, asked, rtol=rtol, max_steps=max_steps)
    return jax.tree.map(lambda leaf: np.asarray(leaf)[:count], met)
