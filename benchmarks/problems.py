"""What is fitted: simulated data with known truth, and where all start."""

import dataclasses
from functools import cached_property

import jax
import jax.numpy as jnp
import numpy as np

import brdffit
from brdffit import AbstractBRDF, Goniometer, Noise, Samples
from brdffit.fit.blocks import usable
from brdffit.fit.residual import Residual, cosine_weighted, log
from brdffit.fit.transforms import Layout, pack, to_natural, to_solver, unpack
from brdffit.parameters import replace
from brdffit.samples import as_samples

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
    """Samples of which every value counts, and a start.

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
        return to_solver(self.layout, pack(brdf))

    @cached_property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """Directions, weights and values in double precision."""
        samples = self.samples
        names = (samples.wi, samples.wo, samples.weight, samples.value)
        return tuple(np.ascontiguousarray(array, np.float64) for array in names)

    @cached_property
    def vector(self):
        """Compiled residual vector of a point, as anyone would write it in JAX.

        To be called, like all that is made of it, with double precision enabled.
        """
        wi, wo, weight, value = (jnp.asarray(array) for array in self.arrays)
        cosines = jnp.asarray(self.samples.cosine, float)[:, None], wo[:, 2:]
        target = self.residual.transform(value, *cosines)
        base = jax.tree.map(lambda leaf: jnp.asarray(leaf, float), self.start)
        places = tuple(range(len(self.x0)))

        def vector(x):
            brdf = unpack(self.layout, base, to_natural(self.layout, x, places))
            f_r = jax.vmap(jax.vmap(brdf, (0, None)))(wi, wo)
            predicted = jnp.sum(f_r * weight, axis=1)
            return (self.residual.transform(predicted, *cosines) - target).ravel()

        return jax.jit(vector)

    def cost(self, x: np.ndarray) -> float:
        """Half the sum of squares at a point."""
        with jax.enable_x64(True):
            error = np.asarray(self.vector(jnp.asarray(x)))
        return 0.5 * float(error @ error)


def sphere(model: str, lights: int, resolution: int = 128) -> Problem:
    """Image of a sphere under the first few lights; every lit pixel counts."""
    scene = brdffit.lit_sphere(resolution, LIGHTS[:lights])
    image = brdffit.simulate_image(_truth(model), scene, Noise(NOISE, seed=SEED))
    return _problem(model, image, cosine_weighted)


def goniometer(model: str, samples: int = 100_000) -> Problem:
    """Reflectance on a grid of about as many pairs of directions, compared by log."""
    side = round((samples / 5) ** (1 / 3))
    setup = Goniometer(
        theta_i=np.linspace(2, 80, side),
        theta_o=np.linspace(2, 80, side),
        phi=np.linspace(0, 180, 5 * side),
    )
    table = brdffit.simulate_measurement(_truth(model), setup, Noise(NOISE, seed=SEED))
    return _problem(model, as_samples(table), log)


def _truth(model: str) -> AbstractBRDF:
    return brdffit.MODELS[model](**TRUTHS[model])


def _problem(model: str, samples: Samples, residual: Residual) -> Problem:
    samples = dataclasses.replace(samples, sigma=None)
    whole = usable(samples, residual).all(axis=1)
    samples = dataclasses.replace(samples.take(whole), mask=None, pixels=None)
    truth = _truth(model)
    start = {
        name: np.full_like(np.asarray(value, float), STARTS.get(name, 0.5))
        for name, value in brdffit.parameters.values(truth).items()
    }
    return Problem(replace(truth, start), samples, residual)
