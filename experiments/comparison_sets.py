"""Materials that three classic models are compared on, and their spheres.

Each is what a fit sees, and what it reflects at any directions: simulated materials by
their model, measured ones by interpolating the measurement (RGL).
"""

import dataclasses
from collections.abc import Callable

import jax.numpy as jnp
import numpy as np

import brdffit
from brdffit import Goniometer, Noise, simulate_measurement
from brdffit.fit.appearance import LIGHTS
from brdffit.models import MODELS
from brdffit.readers import rgl
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.samples import Measurement, as_samples
from brdffit.scene import lit_sphere
from brdffit.subset import subset
from experiments.merl_standins import DATA

TRUTHS = {
    "phong": {"diffuse": [0.1, 0.25, 0.4], "specular": 0.3, "exponent": 60.0},
    "cook_torrance": {
        "diffuse": [0.3, 0.12, 0.08],
        "specular": 0.5,
        "f0": 0.2,
        "alpha": 0.25,
    },
    "oren_nayar": {"albedo": [0.6, 0.45, 0.3], "sigma": 0.5},
}
MEASURED = {
    "golden yellow": "vch_golden_yellow_rgb",
    "mint": "chm_mint_rgb",
    "military green": "cm_military_green_rgb",
    "white paper": "paper_white_rgb",
    "iridescent flake paint": "irid_flake_paint1_rgb",
}
GRID = Goniometer(
    theta_i=np.arange(5, 81, 8), theta_o=np.arange(2, 83, 6), phi=np.arange(0, 181, 15)
)
SEED = 0


@dataclasses.dataclass(frozen=True)
class Material:
    """What is fitted, and what it reflects at any directions.

    Attributes:
        data: Samples that a fit sees.
        f_r: Reflectance ``(N, 3)`` of directions ``(N, 3)``.
    """

    data: Measurement
    f_r: Callable


def modelled(brdf):
    """A model as a function of directions."""

    def f_r(wi, wo):
        blank = Measurement(wi=wi, wo=wo, f_r=np.ones((len(wi), 3), np.float32))
        return np.asarray(compiled_shade(brdf, as_samples(blank)))

    return f_r


def materials(samples):
    """All sets, by name."""
    found = {}
    for name, values in TRUTHS.items():
        spread = {
            k: jnp.full(3, v) if k == "specular" else v for k, v in values.items()
        }
        brdf = MODELS[name](**spread)
        data = subset(simulate_measurement(brdf, GRID, Noise(0.01, seed=SEED)), samples)
        # weighted like the measured ones, evenly, so that fits are compiled once
        even = np.ones(len(data))
        data = dataclasses.replace(data, sigma=None, solid_angle=even)
        found[f"simulated {name}"] = Material(data, modelled(brdf))
    for name, file in MEASURED.items():
        path = DATA / "rgl" / f"{file}.bsdf"
        if path.exists():
            data = subset(brdffit.load(path), samples)
            found[name] = Material(
                data, lambda wi, wo, path=path: rgl.evaluate(path, wi, wo)
            )
    return found


def sphere(f_r, resolution):
    """Image of a sphere under two lights, NaN beside it, and its lit pixels."""
    samples = trace(lit_sphere(resolution, LIGHTS), channels=3)
    wi, weight = np.asarray(samples.wi), np.asarray(samples.weight)
    values = np.zeros((len(wi), 3))
    for light in range(wi.shape[1]):
        lit = (wi[:, light, 2] > 0) & weight[:, light].any(axis=1)
        here = f_r(wi[lit, light], np.asarray(samples.wo)[lit])
        values[lit] += np.maximum(here, 0) * weight[lit, light]
    return samples.pixels.images(values.astype(np.float32))[0], values
