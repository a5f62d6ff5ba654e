"""From many starts to the best minimum: sort out on few samples, finish on all."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from brdffit.compiled import compiled
from brdffit.fit import structure
from brdffit.fit.basis import Problem
from brdffit.fit.blocks import AHEAD
from brdffit.fit.start import typical_box
from brdffit.fit.status import CONVERGED
from brdffit.types import AnyArray

RTOL = {"float64": 1e-9, "float32": 1e-8}
ROUGH = 1e-6  # the same on few samples
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
        origin: Which start each came from.
    """

    x: Float[AnyArray, "*start n"]
    cost: Float[AnyArray, "*start"]
    rounding: Float[AnyArray, "*start"]
    steps: Int[AnyArray, "*start"]
    status: Int[AnyArray, "*start"]
    origin: Int[AnyArray, "*start"]


class Search(eqx.Module):
    """The outcome of a search.

    Attributes:
        x: The best point found.
        cost: What is minimised, there.
        steps: Steps of the solves that led there.
        status: Outcome of the last of them, a place in `STATUS`.
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
    problem: Problem,
    starts: Float[np.ndarray, "start n"],
    rtol: float,
    max_steps: int,
) -> Search:
    """Solve from all starts and return the best minimum.

    With many samples all starts run on the first blocks, which stand for all and tell
    the basins apart, and only the best few are finished on all.

    Args:
        problem: The fit.
        starts: Starting points in solver coordinates.
        rtol: Relative decrease of the cost at which to stop.
        max_steps: Steps after which a start gives up.
    """
    solved, number = _compiled_solve(problem, starts, rtol=rtol, max_steps=max_steps)
    solved = jax.tree.map(lambda leaf: np.asarray(leaf)[: int(number)], solved)
    return outcome(solved, len(starts))


def outcome(solved: Minima, count: int) -> Search:
    """The best minimum, and how many there are.

    Args:
        solved: Where the ``count`` starts ended, and, when that was on few samples,
            where the best of them were finished.
        count: Number of starts.
    """
    met = jax.tree.map(lambda leaf: leaf[:count], solved)
    final = jax.tree.map(lambda leaf: leaf[count:], solved)
    staged = len(final.cost) > 0
    final = final if staged else met
    best = _best(final)
    near = met.cost <= np.nanmin(met.cost) + _same(met)
    before = met.steps[final.origin[best]] if staged else 0
    return Search(
        x=final.x[best],
        cost=float(final.cost[best]),
        steps=int(final.steps[best] + before),
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


def _same(met: Minima) -> AnyArray:
    """Difference in cost up to which two minima count as one."""
    return SAME_BASIN * abs(met.cost) + 4 * met.rounding


def _distinct(met: Minima) -> np.ndarray:
    """Index of one start per basin, the best first."""
    cost, same = met.cost, _same(met)
    order = np.argsort(cost)
    new = np.ones(len(order), bool)
    new[1:] = cost[order[1:]] > cost[order[:-1]] + same[order[1:]]
    return order[new & np.isfinite(cost[order])]


def _solve(
    problem: Problem, starts: AnyArray, rtol: float, max_steps: int
) -> tuple[Minima, AnyArray]:
    """Where all starts end, and then their best few; and how many that makes.

    One after the other in one program: each start takes the steps that it needs and no
    more; batched, all would take those of the slowest, and the small matrix products
    of a batch are slow on a CPU.
    """
    count = len(starts)
    number = problem.blocks.count
    staged = number > AHEAD
    room = count + FINALISTS

    def go_on(state):
        i, solved, left = state
        first_of_last = i == count  # without any finite cost, a start is tried again
        more = (i < room) & (first_of_last | jnp.any(left))
        return (i < count) | (staged & more)

    def one_more(state):
        i, solved, left = state
        rough = staged & (i < count)
        best = jnp.argmin(jnp.where(left, solved.cost, jnp.inf))
        origin = jnp.where(i < count, i, best)
        # of starts that end in one minimum the best is finished
        same = solved.cost <= solved.cost[best] + _same(solved)[best]
        left = jnp.where(i < count, left, left & ~same)
        start = starts[jnp.minimum(origin, count - 1)]
        given = (i < count) | ~jnp.isfinite(solved.cost[best])
        new = _from_start(
            _of_blocks(problem, jnp.where(rough, AHEAD, number)),
            jnp.where(given, start, solved.x[best]),
            jnp.where(rough, ROUGH, rtol),
            max_steps,
        )
        new = dataclasses.replace(new, origin=origin)
        solved = jax.tree.map(lambda all, one: all.at[i].set(one), solved, new)
        finite = (i < count) & jnp.isfinite(new.cost)
        return i + 1, solved, left.at[i].set(finite)

    shapes = jax.eval_shape(
        lambda problem, x: _from_start(problem, x, rtol, max_steps), problem, starts[0]
    )
    empty = jax.tree.map(lambda s: jnp.zeros((room, *s.shape), s.dtype), shapes)
    state = jnp.array(0), empty, jnp.zeros(room, bool)
    done, solved, _ = jax.lax.while_loop(go_on, one_more, state)
    return solved, done


_compiled_solve = compiled(_solve, static=("rtol", "max_steps"))


def _of_blocks(problem: Problem, count) -> Problem:
    """The fit to the first blocks alone."""
    blocks = dataclasses.replace(problem.blocks, count=count)
    return dataclasses.replace(problem, blocks=blocks)


def _from_start(problem: Problem, x, rtol, max_steps: int) -> Minima:
    """Where one start ends.

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
    projected = problem.projected
    seen = nonlinear if projected else np.arange(x.shape[0])

    def equations(x, problem):
        if projected:
            return structure.project(problem, x)
        return structure.stream(problem, x), jnp.zeros((layout.channels, 0))

    if not projected:
        low, high = (box[linear_places] for box in typical_box(layout))
        _, linear = structure.project(problem, x[nonlinear], derivatives=False)
        given = x[linear_places]
        begin = jnp.where(jnp.isnan(given), jnp.clip(linear, low, high), given)
        x = x.at[linear_places].set(begin)
    solution = optx.least_squares(
        equations,
        BoundedLevenbergMarquardt(rtol),
        x[seen],
        args=problem,
        options={"lower": problem.lower[seen], "upper": problem.upper[seen]},
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
        origin=jnp.array(0),
    )
