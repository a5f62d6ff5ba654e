"""Fits of one texture on a given number of cores, for `texture_fit`; prints JSON."""

import ctypes
import json
import os
import sys
import time

import jax
import jax.numpy as jnp
import numpy as np
import scipy.optimize

from benchmarks import ceres
from benchmarks.measure import ALL_CORES
from benchmarks.textures import Texture, texture
from brdffit.fit.texture import fit_texels
from brdffit.fit.transforms import to_natural, unpack

SAME = 1e-3  # cost above the least known, as a share of it, that is the same minimum
TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)
LOST = 1e-3  # share of texels that a looser tolerance may lose


def ours(task: Texture):
    """`fit_texels`, by as many threads as it takes for the cores that it may use."""
    return task.points(fit_texels(task.model, task.texels).parameters)


def tiny_solver(task: Texture, threads: int, tolerance: float, start: np.ndarray):
    """TinySolver of Ceres from one start ``(n,)`` or one for each texel."""
    arrays = [
        np.ascontiguousarray(np.moveaxis(array, -1, 0), np.float64)
        for array in (
            task.texels.wi,
            task.texels.wo,
            task.texels.weight,
            task.texels.value,
        )
    ]
    lower, upper = (np.ascontiguousarray(bound) for bound in task.bounds)
    texels, observations = arrays[0].shape[:2]
    solve = ceres.library(ceres.TEXTURE).texture_solve
    begin = np.broadcast_to(np.atleast_2d(start.T), (texels, len(lower)))

    def run():
        points = np.array(begin, np.float64, order="C")
        solve(
            task.model.encode(),
            texels,
            observations,
            *map(_pointer, (*arrays, lower, upper)),
            threads,
            ctypes.c_double(tolerance),
            _pointer(points),
        )
        return points.T

    return run


def scipy_loop(task: Texture):
    """`scipy.optimize.least_squares` in a loop, residuals and Jacobian compiled."""
    layout, brdf = task.layout, task.brdf
    places = tuple(range(len(layout.labels)))

    def residuals(x, wi, wo, weight, value):
        found = unpack(layout, brdf, to_natural(layout, x, places))
        return (jax.vmap(found.evaluate)(wi, wo) * weight - value).ravel()

    with jax.enable_x64(True):
        vector, jacobian = jax.jit(residuals), jax.jit(jax.jacfwd(residuals))
    t = task.texels

    def run():
        points = np.empty_like(task.truth)
        with jax.enable_x64(True):
            for i in range(points.shape[1]):
                own = [
                    jnp.asarray(array[..., i], jnp.float64)
                    for array in (t.wi, t.wo, t.weight, t.value)
                ]
                points[:, i] = scipy.optimize.least_squares(
                    lambda x, own=own: np.asarray(vector(x, *own)),
                    task.middle,
                    lambda x, own=own: np.asarray(jacobian(x, *own)),
                    bounds=task.bounds,
                ).x
        return points

    return run


def measure(model: str, texels: int, few: int, threads: int, turns: int) -> list[dict]:
    """Lines of a table: speed and share of right minima of each contestant."""
    if threads == 1:
        os.sched_setaffinity(0, {max(ALL_CORES)})
    task, small = texture(model, texels), texture(model, few)
    calls = {"brdffit": (task, lambda: ours(task))}
    least = task.costs(task.truth)
    if why := ceres.why_absent():
        print(why)
    else:
        runs = {t: tiny_solver(task, threads, t, task.middle) for t in TOLERANCES}
        from_truth = tiny_solver(task, threads, TOLERANCES[-1], task.truth)()
        least = np.fmin(least, task.costs(from_truth))
        costs = {t: task.costs(run()) for t, run in runs.items()}
        least = np.fmin(least, costs[TOLERANCES[-1]])
        shares = {t: _right(cost, least) for t, cost in costs.items()}
        enough = max(shares.values()) - LOST
        tolerance = next(t for t in TOLERANCES if shares[t] >= enough)
        calls["Ceres TinySolver"] = task, runs[tolerance]
    if threads == 1:
        calls["scipy least_squares, a loop"] = small, scipy_loop(small)
    first = time.perf_counter()
    costs = {name: t.costs(run()) for name, (t, run) in calls.items()}
    first = time.perf_counter() - first
    least = np.fmin(least, costs["brdffit"])
    wall = {name: [] for name in calls}
    for turn in range(turns):
        for name, (_, run) in calls.items():
            if name.startswith("scipy") and turn:
                continue
            begin, used = time.perf_counter(), time.process_time()
            run()
            taken = time.perf_counter() - begin
            used = time.process_time() - used
            wall[name].append(used if threads == 1 else taken)
    rows = []
    for name, (t, _) in calls.items():
        size = len(t.texels)
        known = least if t is task else np.fmin(costs[name], small.costs(small.truth))
        right = _right(costs[name], known)
        seconds = float(np.median(wall[name]))
        rows.append(
            {
                "model": model,
                "contestant": name,
                "threads": threads,
                "texels": size,
                "right": f"{right:.4%}",
                "wrong": f"{1 - right:.4%}",
                "seconds": seconds,
                "texels_per_s": size / seconds,
            }
        )
    for row in rows:
        row["brdffit_over_it"] = rows[0]["texels_per_s"] / row["texels_per_s"]
    return rows


def _right(cost: np.ndarray, least: np.ndarray) -> float:
    """Share of texels at the least cost that is known."""
    return float(np.mean(cost <= (1 + SAME) * least))


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    return array.ctypes.data_as(ctypes.c_void_p)


if __name__ == "__main__":
    print(json.dumps(measure(**json.loads(sys.argv[1]))))
