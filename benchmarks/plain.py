"""Peers in Python on the plain residual vector, in double precision."""

import jax
import jax.numpy as jnp
import numpy as np
import optimistix as optx
import scipy.optimize

from benchmarks.measure import Contestant
from benchmarks.problems import Problem

MAX_STEPS = 400
SOLVERS = {"LM": optx.LevenbergMarquardt, "Dogleg": optx.Dogleg}


def optimistix(problem: Problem, solver: str) -> Contestant:
    """A solver of optimistix as it comes, the whole solve in one compiled program."""

    @jax.jit
    def program(x, tolerance):
        solution = optx.least_squares(
            lambda x, _: problem.vector(x),
            SOLVERS[solver](rtol=tolerance, atol=tolerance),
            x,
            max_steps=MAX_STEPS,
            throw=False,
        )
        return solution.value, solution.stats["num_steps"]

    def run(tolerance):
        with jax.enable_x64(True):
            x, steps = program(jnp.asarray(problem.x0), tolerance)
        return np.asarray(x), int(steps)

    return Contestant(f"optimistix {solver}", run)


def scipy_lm(problem: Problem, analytic: bool) -> Contestant:
    """MINPACK by way of scipy; the residual vector is compiled by JAX.

    Analytic stands for the exact Jacobian by forward-mode differentiation, compiled.
    """
    with jax.enable_x64(True):
        jacobian = jax.jit(jax.jacfwd(problem.vector))

    def run(tolerance):
        def vector(x):
            return np.asarray(problem.vector(jnp.asarray(x)))

        def slopes(x):
            return np.asarray(jacobian(jnp.asarray(x)))

        with jax.enable_x64(True):
            found = scipy.optimize.least_squares(
                vector,
                problem.x0,
                slopes if analytic else "2-point",
                method="lm",
                ftol=tolerance,
                xtol=tolerance,
                max_nfev=MAX_STEPS,
            )
        return found.x, found.nfev

    kind = "analytic" if analytic else "finite differences"
    return Contestant(f"scipy lm, {kind}", run)
