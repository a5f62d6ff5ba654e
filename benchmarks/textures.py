"""Synthetic textures: every texel a random material under its own directions."""

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np

from brdffit import MODELS, AbstractBRDF
from brdffit.fit.start import typical_box
from brdffit.fit.texture import Texels
from brdffit.fit.transforms import Layout, bounds, to_natural, unpack

OBSERVATIONS, CHANNELS = 24, 3
NOISE = 0.01  # standard deviation as a share of the median value of a texel
WITHIN = (0.3, 0.9)  # share of the typical ranges in which materials lie


@dataclasses.dataclass(frozen=True)
class Texture:
    """A model, texels of it, and in solver coordinates what they were made from.

    Attributes:
        model: Name of the model.
        texels: Observations.
        truth: The parameters ``(n, texel)``.
    """

    model: str
    texels: Texels
    truth: np.ndarray

    @property
    def brdf(self) -> AbstractBRDF:
        """The model with any values."""
        return MODELS[self.model]()

    @property
    def layout(self) -> Layout:
        """Where each parameter stands."""
        return Layout.of(self.brdf)

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Bounds in solver coordinates."""
        return bounds(self.layout)

    @property
    def middle(self) -> np.ndarray:
        """The middle of the typical ranges, in solver coordinates."""
        return np.mean(typical_box(self.layout), axis=0)

    def points(self, parameters) -> np.ndarray:
        """Fitted parameters by name as ``(n, texel)`` in solver coordinates."""
        natural = np.concatenate([parameters[name] for name, _ in self.layout.entries])
        return np.stack(
            [
                np.log(row) if known.logarithmic and known.lower > 0 else row
                for row, known in zip(
                    natural.astype(float), self.layout.known, strict=True
                )
            ]
        )

    def costs(self, points: np.ndarray) -> np.ndarray:
        """Half the sum of squares of each texel, in double precision."""
        with jax.enable_x64(True):
            double = [
                jnp.asarray(array, jnp.float64)
                for array in (points, self.texels.wi, self.texels.wo)
            ]
            f_r = np.asarray(_reflectance(self.model, *double))
        error = f_r * self.texels.weight - self.texels.value
        return np.sum(error**2, axis=(0, 1)) / 2


@partial(jax.jit, static_argnums=0)
def _reflectance(model: str, points, wi, wo):
    """``f_r (observation, channel, texel)``."""
    brdf = MODELS[model]()
    layout = Layout.of(brdf)

    def one(x, wi, wo):
        natural = to_natural(layout, x, tuple(range(len(layout.labels))))
        return unpack(layout, brdf, natural).evaluate(wi, wo)

    return jax.vmap(jax.vmap(one, (1, 1, 1), 1), (None, 0, 0))(points, wi, wo)


def texture(model: str, texels: int, seed: int = 1) -> Texture:
    """Texels of random materials, with noise."""
    random = np.random.default_rng(seed)
    layout = Layout.of(MODELS[model]())
    low, high = typical_box(layout)
    share = random.uniform(*WITHIN, (len(low), texels))
    truth = low[:, None] + share * (high - low)[:, None]
    wi, wo = _upward(random, texels), _upward(random, texels)
    weight = wi[:, 2:]
    f_r = np.asarray(_reflectance(model, truth.astype(np.float32), wi, wo))
    value = f_r * weight
    spread = NOISE * np.median(value, axis=(0, 1))
    value += spread * random.standard_normal(value.shape, np.float32)
    return Texture(model, Texels(wi, wo, weight, value.astype(np.float32)), truth)


def _upward(random: np.random.Generator, texels: int) -> np.ndarray:
    """Directions between the normal and 78 degrees, uniform in solid angle."""
    shape = OBSERVATIONS, texels
    cosine, phi = random.uniform(0.2, 1, shape), random.uniform(0, 2 * np.pi, shape)
    sine = np.sqrt(1 - cosine**2)
    w = np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=1)
    return w.astype(np.float32)
