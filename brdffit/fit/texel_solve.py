r"""The solver of many small fits: a screen of starts, then Levenberg-Marquardt.

Every texel takes its own steps with its own damping, and is left alone once it has
converged, so that what is found for it does not depend on its neighbours.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from brdffit.fit.solve import FIRST_DAMPING, LEAST_GAIN
from brdffit.fit.start import typical_box
from brdffit.fit.texel_basis import Observed, TexelBlock, TexelProblem, observed
from brdffit.fit.texel_equations import Sums, best_linear, side_by_side, sums
from brdffit.fit.texel_step import assembled, propose

RTOL = 1e-5  # relative decrease at which to stop; a few hundredths of an error bar


class Progress(eqx.Module):
    """How far the solver has come with each texel.

    Attributes:
        x: All parameters in solver coordinates.
        damping: Levenberg-Marquardt parameter, relative to the diagonal.
        growth: Factor by which the next refusal raises the damping.
        converged: True where nothing that could be seen is left to gain.
        steps: Points evaluated with derivatives.
    """

    x: Float[Array, "n texel"]
    damping: Float[Array, " texel"]
    growth: Float[Array, " texel"]
    converged: Bool[Array, " texel"]
    steps: Int[Array, " texel"]


class Solved(eqx.Module):
    """Progress, and what errors at the points reached need.

    Attributes:
        progress: Where each texel stands.
        cost: Half the sum of squares.
        count: Number of values used.
        hessian: Second derivative of the cost in all parameters.
    """

    progress: Progress
    cost: Float[Array, " texel"]
    count: Float[Array, " texel"]
    hessian: Float[Array, "n n texel"]


class _State(eqx.Module):
    """Progress, the sums there, and the step that will be tried next."""

    progress: Progress
    sums: Sums
    cost: Float[Array, " texel"]
    step: Float[Array, "solved texel"]
    predicted: Float[Array, " texel"]


def begun(x: Float[Array, "n texel"]) -> Progress:
    """Progress of texels that begin at ``x``."""
    return Progress(
        x=x,
        damping=jnp.full_like(x[0], FIRST_DAMPING),
        growth=jnp.full_like(x[0], 2),
        converged=jnp.zeros_like(x[0], bool),
        steps=jnp.zeros_like(x[0], jnp.int32),
    )


def solve(
    problem: TexelProblem,
    block: TexelBlock,
    begin: Progress,
    starts: Float[Array, "start n"],
    tried: int | Array,
    most: int | Array,
) -> Solved:
    """Begin at the best of some starts, and go up to ``most`` steps.

    Args:
        problem: What all texels have in common.
        block: What was observed of some of them.
        begin: Where they stand.
        starts: Points in solver coordinates.
        tried: How many of them to try; with none, texels go on from ``begin``.
        most: Steps for each texel that has not converged.
    """
    seen = observed(problem, block)
    x = _screened(problem, seen, begin.x, starts, tried)
    return _refined(problem, seen, eqx.tree_at(lambda b: b.x, begin, x), most)


def _screened(
    problem: TexelProblem,
    seen: Observed,
    x: Array,
    starts: Array,
    tried: int | Array,
) -> Array:
    """The best of the starts for each texel, the linear parameters solved."""
    places = problem.linear_places
    low, high = (box[places][..., None] for box in typical_box(problem.layout))

    def try_one(i, best):
        x, least = best
        start = starts[i]
        linear, cost = best_linear(problem, seen, start)
        if not problem.residual.affine:
            # at a bound, such as a lobe of no height, others may have no effect
            linear = jnp.clip(linear, low, high).astype(linear.dtype)
        trial = _put(jnp.broadcast_to(start[:, None], x.shape), places, linear)
        return _where(cost < least, (trial, cost), best)

    least = jnp.full(x.shape[1], jnp.inf, x.dtype)
    return jax.lax.fori_loop(0, tried, try_one, (x, least))[0]


def _refined(
    problem: TexelProblem, seen: Observed, begin: Progress, most: int | Array
) -> Solved:
    """Up to ``most`` steps of each texel that has not converged."""
    affine, places = problem.residual.affine, problem.solved_places
    lower, upper = (b[places][:, None] for b in (problem.lower, problem.upper))
    eps = 8 * jnp.finfo(seen.value.dtype).eps
    floor = eps**2 * jnp.sum((seen.lean * seen.value) ** 2, axis=(0, 1))

    def judge(state: _State, cost: Array):
        """Whether the step was good, and the damping and its growth after it."""
        old = state.progress
        first, rounding = jnp.isinf(state.cost), eps * cost + floor
        tiny = jnp.finfo(cost.dtype).tiny
        gain = (state.cost - cost) / jnp.maximum(state.predicted, tiny)
        # a step too small for the cost to show is judged by the gradient alone
        unseen = (cost < state.cost + rounding) & (state.predicted < rounding)
        good = (first | unseen | (gain > LEAST_GAIN)) & jnp.isfinite(cost)
        trust = jnp.where(first | unseen, 0.5, jnp.clip(gain, 0, 1))
        softer = old.damping * jnp.maximum(1 / 3, 1 - (2 * trust - 1) ** 3)
        damping = jnp.where(good, softer, old.damping * old.growth)
        return good, damping, jnp.where(good, 2, 2 * old.growth)

    def advance(state: _State) -> _State:
        """Evaluate the proposed point, take or refuse it, propose the next."""
        old = state.progress
        trial = jnp.clip(old.x[places] + state.step, lower, upper)
        x = _put(old.x, places, trial)
        found = sums(problem, seen, x)
        if affine:
            x = _put(x, problem.linear_places, found.linear)
        cost = jnp.sum(found.cost, axis=0)
        good, damping, growth = judge(state, cost)
        now = x, found, cost
        x, found, cost = _where(
            good & ~old.converged, now, (old.x, state.sums, state.cost)
        )
        step, predicted = propose(problem, found, x, damping)
        small = predicted <= RTOL * cost + floor
        new = Progress(x, damping, growth, small & jnp.isfinite(cost), old.steps + 1)
        return _State(_where(old.converged, old, new), found, cost, step, predicted)

    def unfinished(state):
        taken, now = state
        return (taken < most) & ~jnp.all(now.progress.converged)

    texels = begin.x.shape[1]
    empty = jax.eval_shape(lambda: sums(problem, seen, begin.x))
    state = _State(
        progress=begin,
        sums=jax.tree.map(lambda s: jnp.zeros(s.shape, s.dtype), empty),
        cost=jnp.full(texels, jnp.inf, begin.x.dtype),
        step=jnp.zeros((len(places), texels), begin.x.dtype),
        predicted=jnp.zeros(texels, begin.x.dtype),
    )
    _, end = jax.lax.while_loop(
        unfinished, lambda state: (state[0] + 1, advance(state[1])), (0, state)
    )
    everything = np.arange(len(begin.x)), problem.local_places
    _, hessian = assembled(
        end.sums.gradient, end.sums.gram, *everything, jnp.zeros_like(end.cost)
    )
    return Solved(end.progress, end.cost, seen.count, hessian)


def _put(x: Array, places: np.ndarray, values: Array) -> Array:
    """``x (n, texel)`` with the rows at these places replaced."""
    rows = list(x)
    for place, row in zip(places.ravel(), values.reshape(-1, x.shape[1]), strict=True):
        rows[place] = row
    return side_by_side(rows)


def _where(choose: Array, new, old):
    """``new`` of the texels to choose, ``old`` of the others; texels come last."""
    return jax.tree.map(
        lambda n, o: jnp.where(choose.reshape(*[1] * (n.ndim - 1), -1), n, o), new, old
    )
