"""How long does the command line take from nothing to a fit?

`brdffit fit` of a photograph of a sphere, 128 x 128 pixels, in a process of its own:
with an empty cache of compiled programs, with the cache that such a run leaves, and
beside a Python that only imports JAX and optimistix.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import brdffit
from benchmarks.chart import dots
from benchmarks.problems import LIGHTS, NOISE, SEED, truth
from benchmarks.record import RESULTS, facts
from brdffit import Noise
from brdffit.parameters import values
from brdffit.writers import sphere as sphere_writer
from experiments.record import Record

IMPORTS = "import of jax and optimistix"
EMPTY, WARM = "brdffit fit, empty cache", "brdffit fit, warm cache"
MODEL, TURNS = "ggx", 5
CLOSE = 0.02  # relative distance to the true alpha of a right answer


def timed(command: list[str], cache: Path) -> tuple[float, float, str]:
    """Seconds of processors and on the wall that a process takes, and its output."""
    variables = os.environ | {"BRDFFIT_CACHE": str(cache)}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.perf_counter()
    done = subprocess.run(
        command, env=variables, capture_output=True, text=True, check=True
    )
    wall = time.perf_counter() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return used, wall, done.stdout


def right(output: str) -> bool:
    """Whether the command line found the truth."""
    found = json.loads(output)["parameters"]["alpha"]
    return abs(found / float(values(truth(MODEL))["alpha"]) - 1) < CLOSE


def turns_of(image: Path, turns: int, folder: Path) -> dict[str, list]:
    """What each of the three takes, turn by turn."""
    entry = "import sys; from brdffit.cli import main; sys.exit(main())"
    fit = [sys.executable, "-c", entry, "fit", str(image), "--model", MODEL, "--json"]
    imports = [sys.executable, "-c", "import jax, optimistix"]
    found = {EMPTY: [], WARM: [], IMPORTS: []}
    for turn in range(turns):
        cache = folder / f"cache{turn}"
        found[EMPTY].append(timed(fit, cache))
        found[WARM].append(timed(fit, cache))
        found[IMPORTS].append(timed(imports, cache))
    return found


def line(name: str, found: dict[str, list]) -> dict[str, object]:
    """One line of the table; ratios to the imports turn by turn."""
    used, wall = np.array([turn[:2] for turn in found[name]]).T
    least_used, least_wall = np.array([turn[:2] for turn in found[IMPORTS]]).T
    good = name == IMPORTS or all(right(output) for *_, output in found[name])
    low, middle, high = np.quantile(used / least_used, [0.25, 0.5, 0.75])
    return {
        "contestant": name,
        "answer": "right" if good else "wrong",
        "ms": 1e3 * float(np.median(used)),
        "least_ms": 1e3 * float(used.min()),
        "most_ms": 1e3 * float(used.max()),
        "wall_ms": 1e3 * float(np.median(wall)),
        "over_imports": f"{middle:.2f}" if good else "",
        "quartiles": f"{low:.2f}-{high:.2f}" if good else "",
        "wall_over_imports": f"{np.median(wall / least_wall):.2f}" if good else "",
    }


def main(folder=RESULTS / "cold_start", turns=TURNS, resolution=128):
    """Time the three in turns."""
    record = Record(folder, SEED)
    scene = brdffit.lit_sphere(resolution, LIGHTS[:1])
    image = brdffit.simulate_image(truth(MODEL), scene, Noise(NOISE, seed=SEED))
    with tempfile.TemporaryDirectory() as temporary:
        place = Path(temporary)
        sphere_writer.save(image, scene, place / "ball.exr")
        found = turns_of(place / "ball.exr", turns, place)
    rows = [line(name, found) for name in found]
    record.table(rows)
    case = f"{MODEL}, sphere of {resolution} x {resolution} pixels"
    record.figure(dots([{"case": case} | row for row in rows], ("case",), "process"))
    record.close(**facts(turns))
    return rows


if __name__ == "__main__":
    main()
