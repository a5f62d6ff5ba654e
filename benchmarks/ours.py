"""brdffit as a contestant: its compiled solve alone, and the whole call."""

import jax
import jax.numpy as jnp
import numpy as np

import brdffit
from benchmarks.measure import Contestant
from benchmarks.problems import Problem
from brdffit.fit.blocks import blocks
from brdffit.fit.conditions import bounded_problem
from brdffit.fit.fit import MAX_STEPS
from brdffit.fit.search import RTOL, search

OWN = (0.0,)  # the tolerance is the engine's own


def solve_alone(
    problem: Problem,
    precision: str,
    max_steps: int = MAX_STEPS,
    rtol: float | None = None,
) -> Contestant:
    """The program that `fit` runs, on samples laid out before, from one start.

    It stops as `fit` does, unless told other steps or another tolerance.
    """
    rtol = RTOL[precision] if rtol is None else rtol
    samples = problem.samples
    use = np.ones(samples.value.shape, bool)
    with jax.enable_x64(True):
        laid_out = blocks(samples, use, problem.residual, np.dtype(precision))
        bounded = bounded_problem(problem.layout, problem.start, problem.residual, {})
        ready = jax.tree.map(jnp.asarray, bounded(blocks=laid_out))
        starts = np.asarray(problem.x0)[None]

    def run(tolerance):
        del tolerance
        with jax.enable_x64(True):
            met = search(ready, starts, rtol, max_steps)
        return met.x, met.steps

    return Contestant(f"brdffit {precision}", run, tolerances=OWN)


def whole_fit(problem: Problem, precision: str, starts: int = 1) -> Contestant:
    """`brdffit.fit` from samples to errors; with many starts it is told none."""
    model = (
        problem.start
        if starts == 1
        else brdffit.parameters.registry_name(problem.start)
    )

    def run(tolerance):
        del tolerance
        result = brdffit.fit(
            model,
            problem.samples,
            residual=problem.residual,
            starts=starts,
            precision=precision,
        )
        return problem.point(result.brdf), result.steps

    plural = "" if starts == 1 else "s"
    name = f"brdffit.fit {precision}, {starts} start{plural}"
    return Contestant(name, run, tolerances=OWN)
