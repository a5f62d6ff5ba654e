"""Peers in Python on the plain residual vector, in double precision."""

import jax
import jax.numpy as jnp
import numpy as np
import optimistix as optx
import scipy.optimize

from benchmarks.measure import Contestant
from benchmarks.problems import Problem

MAX_STEPS = 400
SOLVERS = {
    "LM": optx.LevenbergMarquardt,
    "Dogleg": optx.Dogleg,
    "Gauss-Newton": optx.GaussNewton,
}
ADAM = 0.9, 0.999, 1e-8  # decay of the two means, and what keeps the quotient finite


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


def bfgs(problem: Problem) -> Contestant:
    """BFGS of optimistix on half the sum of squares."""

    @jax.jit
    def program(x, tolerance):
        solution = optx.minimise(
            lambda x, _: 0.5 * jnp.sum(problem.vector(x) ** 2),
            optx.BFGS(rtol=tolerance, atol=tolerance),
            x,
            max_steps=MAX_STEPS,
            throw=False,
        )
        return solution.value, solution.stats["num_steps"]

    def run(tolerance):
        with jax.enable_x64(True):
            x, steps = program(jnp.asarray(problem.x0), tolerance)
        return np.asarray(x), int(steps)

    return Contestant("optimistix BFGS", run)


def adam(problem: Problem, rate: float, steps: tuple[int, ...]) -> Contestant:
    """Adam at a constant rate; what it is given as tolerance is one over its steps.

    Source:
        D. Kingma, J. Ba, "Adam: A Method for Stochastic Optimization", ICLR 2015.
    """
    first, second, least = ADAM
    slope = jax.grad(lambda x: 0.5 * jnp.mean(problem.vector(x) ** 2))

    def one_more(t, state):
        x, mean, square = state
        g = slope(x)
        mean = first * mean + (1 - first) * g
        square = second * square + (1 - second) * g * g
        unbiased = mean / (1 - first ** (t + 1.0))
        root = jnp.sqrt(square / (1 - second ** (t + 1.0)))
        return x - rate * unbiased / (root + least), mean, square

    @jax.jit
    def program(x, steps):
        zero = jnp.zeros_like(x)
        return jax.lax.fori_loop(0, steps, one_more, (x, zero, zero))[0]

    def run(tolerance):
        count = round(1 / tolerance)
        with jax.enable_x64(True):
            return np.asarray(program(jnp.asarray(problem.x0), count)), count

    return Contestant(f"Adam, rate {rate:g}", run, tolerances=[1 / n for n in steps])
