r"""The solver: Levenberg-Marquardt on normal equations, in a box.

An optimistix least-squares solver whose function returns `NormalEquations` (and, as
auxiliary output, whatever belongs to the point) instead of residuals. A step minimises
the damped quadratic within the bounds, so a solution may sit on a bound and leave it
again; no bound ever ends a solve.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import optimistix as optx
from jaxtyping import Array, Bool, Float, Int

from brdffit.fit.quadratic import minimise_in_box
from brdffit.fit.structure import NormalEquations

FIRST_DAMPING = 1e-3
LEAST_SCALED = 1e-3  # damping, beside the others, of what the residual hardly sees
BLIND_STEPS = 10  # steps judged by the gradient alone, after which to stop
LEAST_GAIN = 1e-4  # share of the predicted decrease that makes a step worth taking


RESULTS = (  # in the order of `status.STATUS`
    optx.RESULTS.successful,
    optx.RESULTS.nonlinear_max_steps_reached,
    optx.RESULTS.nonfinite,
)


def outcome_of(result: optx.RESULTS) -> Int[Array, ""]:
    """Place of an outcome in `status.STATUS`."""
    return jnp.argmax(jnp.stack([jnp.asarray(result == known) for known in RESULTS]))


class State(eqx.Module):
    """Where the solver stands.

    Attributes:
        equations: Normal equations at the present point.
        aux: What the function gave beside them.
        damping: Levenberg-Marquardt parameter, relative to the diagonal.
        growth: Factor by which the next rejection raises the damping.
        step: Step that will be tried next.
        predicted: Decrease of the cost that the quadratic promises for it.
        blind: Number of steps in a row too small for the cost to show.
        first: True until the start itself has been evaluated.
    """

    equations: NormalEquations
    aux: Any
    damping: Float[Array, ""]
    growth: Float[Array, ""]
    step: Float[Array, " n"]
    predicted: Float[Array, ""]
    blind: Int[Array, ""]
    first: Bool[Array, ""]


class BoundedLevenbergMarquardt(optx.AbstractLeastSquaresSolver):
    """Levenberg-Marquardt within ``options["lower"]`` and ``options["upper"]``.

    With ``options["scale"]``, the size of a notable change of each parameter, one that
    the residual hardly sees at present is kept from running away.

    Stops when the decrease that the next step promises is below ``rtol`` of the cost
    plus ``atol``, or is mere rounding of the gradient. Damping follows H. B.
    Nielsen, "Damping Parameter in Marquardt's Method", IMM-REP-1999-05.

    Attributes:
        rtol: Relative decrease at which to stop.
        atol: Absolute decrease at which to stop.
        damping: Damping of the first step, relative to the diagonal.
        norm: Not used: decreases are scalars.
    """

    rtol: Any  # a number, of Python or traced
    atol: float = 0.0
    damping: float = FIRST_DAMPING
    norm: Callable = optx.max_norm

    def init(self, fn, y, args, options, f_struct, aux_struct, tags) -> State:
        """State before the start is evaluated; the first step does that."""
        del fn, args, options, tags
        empty = jax.tree.map(
            lambda s: jnp.zeros(s.shape, s.dtype), (f_struct, aux_struct)
        )
        return State(
            *empty,
            damping=jnp.array(self.damping),
            growth=jnp.array(2.0),
            step=jnp.zeros_like(y),
            predicted=jnp.array(jnp.inf),
            blind=jnp.array(0),
            first=jnp.array(True),
        )

    def step(self, fn, y, args, options, state: State, tags):
        """Evaluate the proposed point, take or refuse it, propose the next."""
        del tags
        trial = jnp.clip(y + state.step, options["lower"], options["upper"])
        equations, aux = fn(trial, args)
        decrease = state.equations.cost - equations.cost
        gain = decrease / jnp.maximum(state.predicted, jnp.finfo(y.dtype).tiny)
        # a step too small for the cost to show is judged by the gradient alone
        unseen = (decrease > -equations.rounding) & (
            state.predicted < equations.rounding
        )
        accept = state.first | (gain > LEAST_GAIN) | unseen

        def choose(new, old):
            return jax.tree.map(lambda n, o: jnp.where(accept, n, o), new, old)

        y = jnp.where(accept, trial, y)
        equations = choose(equations, state.equations)
        trust = jnp.where(unseen, 0.5, jnp.clip(gain, 0, 1))  # 0.5: leave it as it is
        softer = state.damping * jnp.maximum(1 / 3, 1 - (2 * trust - 1) ** 3)
        harder = state.damping * state.growth
        damping = jnp.where(
            state.first, state.damping, jnp.where(accept, softer, harder)
        )
        growth = jnp.where(accept, 2.0, 2 * state.growth)
        step, predicted = self._propose(y, equations, damping, options)
        new = State(
            equations=equations,
            aux=choose(aux, state.aux),
            damping=damping,
            growth=growth,
            step=step,
            predicted=predicted,
            blind=jnp.where(unseen, state.blind + 1, 0),
            first=jnp.array(False),
        )
        return y, new, new.aux

    def _propose(self, y, equations, damping, options):
        if y.size == 0:
            return y, jnp.array(0.0)
        diagonal = jnp.diagonal(equations.hessian)
        if "scale" in options:
            scale = options["scale"]
            typical = jnp.mean(diagonal * scale**2)
            diagonal = diagonal + LEAST_SCALED * typical / scale**2
        damped = equations.hessian + jnp.diag(damping * diagonal)
        step, _ = minimise_in_box(
            damped, equations.gradient, options["lower"] - y, options["upper"] - y
        )
        curvature = jnp.dot(step, equations.hessian @ step) / 2
        return step, -(jnp.dot(equations.gradient, step) + curvature)

    def terminate(self, fn, y, args, options, state: State, tags):
        """Stop when nothing that could be seen is left to gain."""
        del fn, y, args, options, tags
        small = self.rtol * jnp.maximum(state.equations.cost, 0) + self.atol
        done = (state.predicted <= small + state.equations.floor) | (
            state.blind > BLIND_STEPS
        )
        done &= ~state.first
        finite = state.first | jnp.isfinite(state.equations.cost)
        result = optx.RESULTS.where(
            finite, optx.RESULTS.successful, optx.RESULTS.nonfinite
        )
        return done, result

    def postprocess(self, fn, y, aux, args, options, state: State, tags, result):
        """Hand on the solution; its equations are in the state."""
        del fn, args, options, state, tags, result
        return y, aux, {}
