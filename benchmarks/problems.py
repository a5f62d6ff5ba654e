"""What is fitted: simulated data with known truth, and where all start."""

import dataclasses
from functools import cached_property
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

import brdffit
from brdffit import (
    AbstractBRDF,
    Goniometer,
    Measurement,
    Noise,
    Samples,
    half_difference,
)
from brdffit.fit.blocks import usable
from brdffit.fit.plain import residual_vector
from brdffit.fit.residual import Residual, cosine_weighted, log
from brdffit.fit.transforms import Layout, pack, to_solver
from brdffit.parameters import replace
from brdffit.render.shading import compiled_shade
from brdffit.samples import as_samples
from brdffit.writers import merl as merl_writer

NOISE = 0.01  # standard deviation as a share of each value
SEED = 1
# the first is seen by the camera as a highlight; two behind the sphere, at whose
# grazing angles Fresnel's factor rises
LIGHTS = ((-0.48, 0.6, 0.64), (0.8, 0.0, -0.6), (-0.36, -0.48, -0.8))

BASE = {"diffuse": [0.35, 0.15, 0.08]}
TRUTHS = {
    "ggx": BASE | {"f0": [0.12, 0.10, 0.06], "alpha": 0.35**2},
    "ward_duer": BASE
    | {"specular": [0.12, 0.10, 0.06], "alpha_x": 0.12, "alpha_y": 0.3},
    "oren_nayar": {"albedo": [0.35, 0.15, 0.08], "sigma": 0.35},
    "cook_torrance": BASE | {"specular": [0.6, 0.5, 0.3], "f0": 0.2, "alpha": 0.12},
}
STARTS = {"alpha": 0.64, "alpha_x": 0.64, "alpha_y": 0.64, "sigma": 0.8}  # others 0.5


@dataclasses.dataclass(frozen=True)
class Problem:
    """Samples of which every value counts the same, and a start.

    A point is a vector ``x`` of all parameters in the coordinates of brdffit's solver:
    the logarithm of widths, everything else as it is. All contestants move in it.

    Attributes:
        start: The model with the values at which to start.
        samples: What is fitted.
        residual: How values are compared.
    """

    start: AbstractBRDF
    samples: Samples
    residual: Residual

    @cached_property
    def layout(self) -> Layout:
        """Where each parameter stands in a point."""
        return Layout.of(self.start)

    @cached_property
    def x0(self) -> np.ndarray:
        """The start as a point."""
        return self.point(self.start)

    def point(self, brdf: AbstractBRDF) -> np.ndarray:
        """The values of a model as a point."""
        return to_solver(self.layout, pack(self.layout, brdf))

    @cached_property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """Directions, weights and values in double precision."""
        samples = self.samples
        names = (samples.wi, samples.wo, samples.weight, samples.value)
        return tuple(np.ascontiguousarray(array, np.float64) for array in names)

    @cached_property
    def vector(self):
        """Compiled residual vector of a point, without any structure.

        To be called, like all that is made of it, with double precision enabled.
        """
        names = ("wi", "wo", "weight", "value")
        double = dict(zip(names, self.arrays, strict=True))
        cosine = np.asarray(self.samples.cosine, np.float64)
        samples = dataclasses.replace(self.samples, cosine=cosine, **double)
        every = np.ones(samples.value.shape, bool)
        return jax.jit(
            residual_vector(self.layout, self.start, samples, every, self.residual)
        )

    def cost(self, x: np.ndarray) -> float:
        """Half the sum of squares at a point."""
        with jax.enable_x64(True):
            error = np.asarray(self.vector(jnp.asarray(x)))
        return 0.5 * float(error @ error)


def sphere(model: str, lights: int, resolution: int = 128, seed: int = SEED) -> Problem:
    """Image of a sphere under the first few lights; every lit pixel counts."""
    scene = brdffit.lit_sphere(resolution, LIGHTS[:lights])
    image = brdffit.simulate_image(truth(model), scene, Noise(NOISE, seed=seed))
    return _problem(model, image, cosine_weighted)


def goniometer(model: str, samples: int = 100_000, seed: int = SEED) -> Problem:
    """Reflectance on a grid of about as many pairs of directions, compared by log."""
    side = round((samples / 5) ** (1 / 3))
    setup = Goniometer(
        theta_i=np.linspace(2, 80, side),
        theta_o=np.linspace(2, 80, side),
        phi=np.linspace(0, 180, 5 * side),
    )
    table = brdffit.simulate_measurement(truth(model), setup, Noise(NOISE, seed=seed))
    return _problem(model, as_samples(table), log)


def write_merl(model: str, path: Path) -> None:
    """A MERL file of a known model with noise, in place of a measured one."""
    wi, wo, _ = half_difference.cells()
    blank = Measurement(wi=wi, wo=wo, f_r=np.ones((len(wi), 3), np.float32))
    f_r, _ = Noise(NOISE, seed=SEED)(compiled_shade(truth(model), as_samples(blank)))
    above = (wi[:, 2] > 0) & (wo[:, 2] > 0)
    mask = np.broadcast_to(above[:, None], f_r.shape)
    merl_writer.save(dataclasses.replace(blank, f_r=f_r, mask=mask), path)


def merl(model: str, path: Path, every: int = 1) -> Problem:
    """One in so many cells of a MERL file, compared by log."""
    samples = as_samples(brdffit.load(path))
    return _problem(model, samples.take(np.arange(0, len(samples), every)), log)


def truth(model: str) -> AbstractBRDF:
    """The model that the data are simulated from."""
    return brdffit.MODELS[model](**TRUTHS[model])


def _problem(model: str, samples: Samples, residual: Residual) -> Problem:
    samples = dataclasses.replace(samples, sigma=None, solid_angle=None)
    whole = usable(samples, residual).all(axis=1)
    samples = dataclasses.replace(samples.take(whole), mask=None, pixels=None)
    start = {
        name: jnp.full_like(value, STARTS.get(name, 0.5))
        for name, value in brdffit.parameters.values(truth(model)).items()
    }
    return Problem(replace(truth(model), start), samples, residual)
