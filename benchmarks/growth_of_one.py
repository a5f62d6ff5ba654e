"""Time and peak memory of fits of one size, for `benchmarks.growth`; prints JSON."""

import json
import sys
import time
from pathlib import Path

import numpy as np

import brdffit
from benchmarks.problems import NOISE, SEED, truth
from brdffit import Measurement
from brdffit.parameters import values
from brdffit.render.shading import compiled_shade
from brdffit.samples import as_samples

MODEL = "ggx"
CLOSE = 6.0  # standard errors from the truth, within which an answer is right
STATUS, RESET = Path("/proc/self/status"), Path("/proc/self/clear_refs")


def data(count: int) -> Measurement:
    """Reflectance at random pairs of directions, with relative noise."""
    random = np.random.default_rng(SEED)
    shape = (2, count)
    cosine, phi = random.uniform(0.1, 1, shape), random.uniform(0, 2 * np.pi, shape)
    sine = np.sqrt(1 - cosine**2)
    wi, wo = np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=-1)
    wi, wo = wi.astype(np.float32), wo.astype(np.float32)
    blank = Measurement(wi=wi, wo=wo, f_r=np.ones((count, 3), np.float32))
    f_r = np.asarray(compiled_shade(truth(MODEL), as_samples(blank)))
    noise = 1 + NOISE * random.standard_normal(f_r.shape, np.float32)
    return Measurement(wi=wi, wo=wo, f_r=f_r * noise)


def memory(name: str) -> float:
    """Resident memory of this process in MB: ``VmRSS`` now, ``VmHWM`` at its peak."""
    text = STATUS.read_text()
    (line,) = (line for line in text.splitlines() if line.startswith(name))
    return int(line.split()[1]) / 1024


def measure(samples: int, starts: int, precision: str, turns: int) -> dict:
    """Median processor time of a fit, and how far memory rises during it.

    The first fit, which compiles, is not timed; of memory it is the one that counts,
    after a fit of few samples has brought in the libraries.
    """

    def fit(measurement):
        return brdffit.fit(MODEL, measurement, starts=starts, precision=precision)

    measurement = data(samples)
    brdffit.fit(MODEL, data(1000), starts=1)
    before = memory("VmRSS")
    RESET.write_text("5")  # the peak begins anew
    result = fit(measurement)
    peak = memory("VmHWM") - before
    seconds = []
    for _ in range(turns):
        begin = time.process_time()
        result = fit(measurement)
        seconds.append(time.process_time() - begin)
    off = np.concatenate(
        [
            np.ravel((result.parameters[name] - value) / result.standard_errors[name])
            for name, value in values(truth(MODEL)).items()
        ]
    )
    arrays = (measurement.wi, measurement.wo, measurement.f_r)
    size = sum(array.nbytes for array in arrays) / 1024**2
    return {
        "samples": samples,
        "starts": starts,
        "precision": precision,
        "answer": "right" if np.abs(off).max() < CLOSE else "wrong",
        "seconds": float(np.median(seconds)),
        "peak_mb": round(peak, 1),
        "data_mb": round(size, 3),
        "times_data": round(peak / size, 2),
    }


if __name__ == "__main__":
    print(json.dumps(measure(**json.loads(sys.argv[1]))))
