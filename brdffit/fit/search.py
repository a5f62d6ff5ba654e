"""From many starts to the best minimum: sort out on few samples, finish on all."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import optimistix as optx
from jaxtyping import Array, Bool, Float, Int

from brdffit.compiled import compiled
from brdffit.fit import structure
from brdffit.fit.basis import Problem
from brdffit.fit.blocks import blocks
from brdffit.fit.solve import BoundedLevenbergMarquardt
from brdffit.fit.start import typical_box
from brdffit.samples import Samples

RTOL = {"float64": 1e-10, "float32": 1e-9}
SCREEN = 4096  # samples on which many starts are sorted out
FINALISTS = 3  # minima that are finished on all samples
SAME_BASIN = 1e-3  # relative difference in cost below which two minima are one


class Minima(eqx.Module):
    """Where starts ended, or where one did.

    Attributes:
        x: All parameters in solver coordinates.
        cost: Half the weighted sum of squares.
        rounding: Error of the cost.
        steps: Solver steps taken.
        status: Outcome of each solve.
    """

    x: Float[Array, "*start n"]
    cost: Float[Array, "*start"]
    rounding: Float[Array, "*start"]
    steps: Int[Array, "*start"]
    status: optx.RESULTS


class Search(eqx.Module):
    """The outcome of a search.

    Attributes:
        x: The best point found.
        cost: What is minimised, there.
        steps: Steps of the solve that found it.
        status: Its outcome.
        basins: Number of distinct minima met.
        agreement: Share of starts that ended in the best one.
    """

    x: np.ndarray
    cost: float
    steps: int
    status: optx.RESULTS
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

    With many samples all starts run on a share of them, which tells their basins apart,
    and only the best few are finished on all.

    Args:
        problem: Everything but the samples; called with ``blocks``.
        exact: The same with all samples, in double precision.
        samples: What to explain.
        use: Which values count.
        starts: Starting points in solver coordinates.
        precision: Precision in which models are evaluated.
        max_steps: Steps after which a start gives up.
    """
    dtype, rtol = np.dtype(precision), RTOL[precision]
    residual = problem.keywords["residual"]
    rows = np.flatnonzero(use.any(axis=1))
    met = None
    if len(rows) > SCREEN and len(starts) > 1:
        few = _screen(samples, rows)
        sample = problem(blocks=blocks(samples.take(few), use[few], residual, dtype))
        met = solve(sample, jnp.asarray(starts), rtol=rtol, max_steps=max_steps)
        # always as many, so that one program serves: the best stands in for absent ones
        finalists = np.resize(_distinct(met)[:FINALISTS], FINALISTS)
        starts = np.asarray(met.x)[finalists]
    whole = exact
    if dtype != exact.blocks.wi.dtype:
        whole = problem(blocks=blocks(samples, use, residual, dtype))
    final = solve(whole, jnp.asarray(starts), rtol=rtol, max_steps=max_steps)
    return outcome(final if met is None else met, final)


def outcome(met: Minima, final: Minima) -> Search:
    """The best minimum, and how many there are.

    Args:
        met: Where the starts ended.
        final: Where the best of them were finished.
    """
    near = np.asarray(met.cost) <= np.nanmin(met.cost) + _same(met)
    best = _best(final)
    return Search(
        x=np.asarray(final.x[best]),
        cost=float(final.cost[best]),
        steps=int(final.steps[best]),
        status=jax.tree.map(lambda leaf: leaf[best], final.status),
        basins=len(_distinct(met)),
        agreement=float(np.mean(near)),
    )


def _screen(samples: Samples, rows: np.ndarray) -> np.ndarray:
    """Rows that stand for all: every so-manieth, and more of the brightest."""
    bright = rows[
        np.argsort(np.nansum(np.asarray(samples.value)[rows], axis=1))[
            -len(rows) // 20 :
        ]
    ]
    share = SCREEN // 4
    even = rows[:: -(-len(rows) // (SCREEN - share))]
    return np.union1d(even, bright[:: max(1, len(bright) // share)][:share])


def _best(met: Minima) -> int:
    """The lowest minimum; among equals, one whose solve was completed."""
    cost = np.where(np.isfinite(met.cost), met.cost, np.inf)
    worse = cost > np.min(cost) + 4 * np.asarray(met.rounding)
    unfinished = np.asarray(met.status != optx.RESULTS.successful)
    return int(np.lexsort((cost, unfinished, worse))[0])


def _same(met: Minima) -> np.ndarray:
    """Difference in cost up to which two minima count as one."""
    return SAME_BASIN * np.abs(met.cost) + 4 * np.asarray(met.rounding)


def _distinct(met: Minima) -> np.ndarray:
    """Index of one start per basin, the best first."""
    cost, same = np.asarray(met.cost), _same(met)
    order = np.argsort(cost)
    new = np.ones(len(order), bool)
    new[1:] = cost[order[1:]] > cost[order[:-1]] + same[order[1:]]
    return order[new & np.isfinite(cost[order])]


def _solve(problem: Problem, starts: Array, rtol: float, max_steps: int) -> Minima:
    """Solve from every start, one after the other in one program.

    Each start takes the steps that it needs and no more; batched, all would take those
    of the slowest, and the small matrix products of a batch are slow on a CPU.

    Where linear parameters can be eliminated the solver sees the others alone. Where
    not it sees all, and the linear ones whose start is NaN begin where they fit best
    within their typical range: at a bound, such as a lobe of no height, the others may
    have no effect to begin with.
    """
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
            status=solution.result,
        )

    return jax.lax.map(from_start, starts)


solve = compiled(_solve, static=("rtol", "max_steps"))
