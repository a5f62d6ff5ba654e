"""How much faster than Mitsuba 3 with Adam is a fit of its rough plastic?

Mitsuba fits its `roughplastic` (diffuse in three channels and alpha) to a sphere of
128 x 128 pixels that it rendered itself, without noise, by reverse-mode gradients and
Adam at each of three rates, until all four parameters stay within 1 % of the truth for
ten steps. brdffit fits its `plastic_ggx`, the same reflectance, to its own image with
1 % of noise until it has converged. Both use one thread.

Mitsuba's variants that differentiate need LLVM; where it is not found, or is a version
that stops the process, the benchmark ends with a sentence. The environment variable
DRJIT_LIBLLVM_PATH names the library.
"""

import json
import math
import subprocess
import sys
import time

import numpy as np

import brdffit
from benchmarks.measure import use_one_core
from benchmarks.problems import LIGHTS, NOISE, SEED
from benchmarks.record import RESULTS, facts
from brdffit import Noise
from experiments.record import Record

TRUTH = {"diffuse": [0.35, 0.15, 0.08], "alpha": 0.35**2}
START = {"diffuse": [0.5, 0.5, 0.5], "alpha": 0.64}
ETA, RATES, STEPS, CLOSE = 1.5, (0.02, 0.05, 0.1), 200, 0.01
STAY = 10  # steps in a row that must be close
RESOLUTION, RAYS, TURNS = 128, 4, 2


def scene(mi, diffuse, alpha):
    """The sphere in Mitsuba."""
    to_world = mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0])
    film = {
        "type": "hdrfilm",
        "width": RESOLUTION,
        "height": RESOLUTION,
        "rfilter": {"type": "box"},
    }
    sensor = {"type": "orthographic", "to_world": to_world, "film": film}
    light = {
        "type": "directional",
        "direction": [-x for x in LIGHTS[0]],
        "irradiance": {"type": "rgb", "value": [math.pi] * 3},
    }
    bsdf = {
        "type": "roughplastic",
        "distribution": "ggx",
        "alpha": alpha,
        "int_ior": ETA,
        "ext_ior": 1.0,
        "nonlinear": True,
        "diffuse_reflectance": {"type": "rgb", "value": diffuse},
    }
    integrator = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": integrator,
            "sensor": sensor,
            "light": light,
            "sphere": {"type": "sphere", "bsdf": bsdf},
        }
    )


def descend(mi, dr, rate: float) -> dict:
    """Processor time and steps until all parameters stay close, None if they do not.

    `path` holds processor time and largest relative error after every step.
    """
    target = mi.render(scene(mi, **TRUTH), spp=256)
    world = scene(mi, **START)
    parameters = mi.traverse(world)
    names = {
        name: next(key for key in parameters.keys() if key.endswith(end))  # noqa: SIM118
        for name, end in (("diffuse", "diffuse_reflectance.value"), ("alpha", "alpha"))
    }
    adam = mi.ad.Adam(lr=rate)
    for key in names.values():
        adam[key] = parameters[key]
    parameters.update(adam)
    truth = np.array([*TRUTH["diffuse"], TRUTH["alpha"]])
    begin, reached, path = time.process_time(), None, []
    for step in range(1, STEPS + 1):
        image = mi.render(world, parameters, spp=RAYS, seed=step)
        dr.backward(dr.mean(dr.square(image - target)))
        adam.step()
        for key in names.values():
            adam[key] = dr.clip(adam[key], 1e-3, 1.0)
        parameters.update(adam)
        now = np.concatenate([np.ravel(parameters[key]) for key in names.values()])
        off = float(np.abs(now / truth - 1).max())
        path.append((time.process_time() - begin, off))
        if off > CLOSE:
            reached = None
        elif reached is None:
            reached = {"seconds": path[-1][0], "steps": step}
        elif step - reached["steps"] == STAY:
            break
    reached = reached or {"seconds": None, "steps": STEPS}
    return {"rate": rate, "path": path} | reached


def search() -> list[dict]:
    """Every rate, several times, after a run that is not timed and compiles."""
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    dr.set_thread_count(1)
    descend(mi, dr, RATES[0])
    return [descend(mi, dr, rate) for _ in range(TURNS) for rate in RATES]


def searched() -> list[dict]:
    """What `search` finds in a process of its own; nothing where it does not run."""
    command = [sys.executable, "-m", "benchmarks.mitsuba_adam", "search"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        print("Mitsuba is left out: its variant `llvm_ad_rgb` does not work here.")
        return []
    return json.loads(done.stdout.splitlines()[-1])


def problem(noise: Noise):
    """The same material and start in brdffit: a model and an image."""
    truth = brdffit.MODELS["plastic_ggx"](**TRUTH, eta=ETA)
    scene = brdffit.lit_sphere(RESOLUTION, LIGHTS[:1])
    start = brdffit.MODELS["plastic_ggx"](**START, eta=ETA)
    return start, brdffit.simulate_image(truth, scene, noise)


def off(result) -> float:
    """Largest relative error of a fit."""
    found = np.array([*result.parameters["diffuse"], result.parameters["alpha"]])
    return float(np.abs(found / [*TRUTH["diffuse"], TRUTH["alpha"]] - 1).max())


def ours() -> dict:
    """Processor time of a whole fit of the same material, and its steps."""
    start, image = problem(Noise(NOISE, seed=SEED))
    seconds = []
    for _ in range(TURNS + 1):
        begin = time.process_time()
        result = brdffit.fit(start, image, starts=1, fixed={"eta": ETA})
        seconds.append(time.process_time() - begin)
    return {
        "contestant": "brdffit.fit float64, 1 start",
        "rate": "",
        "answer": "right" if off(result) < CLOSE else "wrong",
        "steps": result.steps,
        "ms": 1e3 * float(np.median(seconds[1:])),
        "over_brdffit": "1.00",
    }


def main(folder=RESULTS / "mitsuba_adam"):
    """Run Mitsuba in a process of its own, and compare."""
    found = searched()
    if not found:
        return []
    record = Record(folder, SEED)
    mine = ours()
    rows = [mine]
    for rate in RATES:
        runs = [run for run in found if run["rate"] == rate]
        right = all(run["seconds"] is not None for run in runs)
        ms = 1e3 * float(np.median([r["seconds"] for r in runs])) if right else math.nan
        rows.append(
            {
                "contestant": "Mitsuba roughplastic + Adam",
                "rate": str(rate),
                "answer": "right" if right else "wrong",
                "steps": int(np.median([run["steps"] for run in runs])),
                "ms": ms,
                "over_brdffit": f"{ms / mine['ms']:.0f}" if right else "",
            }
        )
    record.table(rows)
    record.close(**facts(TURNS))
    return rows


if __name__ == "__main__":
    use_one_core()
    if "search" in sys.argv:
        print(json.dumps(search()))
    else:
        main()
