"""Directions and models for tests, drawn with fixed seeds."""

import itertools
import zlib

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models import AbstractBRDF
from brdffit.parameters import parameters, registry_name, replace, values

GRAZING = 1e-6  # radians above the horizon


def generator(model: type[AbstractBRDF], salt: int = 0) -> np.random.Generator:
    """Random numbers that belong to one model, whatever others there are."""
    return np.random.default_rng([zlib.crc32(registry_name(model).encode()), salt])


def random_directions(rng: np.random.Generator, count: int) -> jax.Array:
    """Directions spread evenly over the hemisphere, at least 0.01 above its edge."""
    z = rng.uniform(0.01, 1.0, count)
    phi = rng.uniform(0, 2 * np.pi, count)
    across = np.sqrt(1 - z * z)
    columns = [across * np.cos(phi), across * np.sin(phi), z]
    return jnp.asarray(np.stack(columns, axis=1))


def incident(degrees: float, azimuth: float = 0.0) -> np.ndarray:
    """Direction in float64, so that grazing cosines keep their digits."""
    theta, phi = np.radians(degrees), np.radians(azimuth)
    across = np.sin(theta)
    return np.array([across * np.cos(phi), across * np.sin(phi), np.cos(theta)])


def corner_directions() -> jax.Array:
    """Where formulas break: normal, grazing, horizon, below, mirror images, an axis."""
    slanted = incident(50, 35)
    grazing = [[np.cos(phi), np.sin(phi), GRAZING] for phi in (0.0, 0.6, np.pi)]
    below = [[0.6, 0.0, -0.8], [0.0, 0.0, -1.0], [1.0, 0.0, -GRAZING]]
    horizon = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    mirrors = [slanted * [-1, -1, 1], [-np.cos(0.6), -np.sin(0.6), GRAZING]]
    rest = [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8], incident(89.9, 90), slanted]
    return jnp.asarray(np.array([*rest, *mirrors, *grazing, *horizon, *below]))


def all_pairs(directions: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Each direction with each, itself included."""
    count = len(directions)
    return jnp.repeat(directions, count, axis=0), jnp.tile(directions, (count, 1))


def random_models(
    model: type[AbstractBRDF], count: int, rng: np.random.Generator
) -> list[AbstractBRDF]:
    """Models with parameters drawn from their typical ranges."""
    brdf = model()
    drawn = []
    for _ in range(count):
        new = {}
        for name, value in values(brdf).items():
            known = parameters(brdf)[name]
            low, high = known.typical
            if known.logarithmic and low > 0:
                number = np.exp(rng.uniform(np.log(low), np.log(high), value.shape))
            else:
                number = rng.uniform(low, high, value.shape)
            new[name] = jnp.asarray(number, value.dtype)
        drawn.append(replace(brdf, new))
    return drawn


def corner_models(model: type[AbstractBRDF]) -> list[AbstractBRDF]:
    """Both ends of each interval, in all combinations.

    Parameters with a value per channel have all ends and the middle in the channels.
    """
    brdf = model()
    known = parameters(brdf)
    own = {name: value for name, value in values(brdf).items() if value.ndim == 0}
    spectral = {
        name: jnp.linspace(known[name].lower, known[name].upper, value.shape[0])
        for name, value in values(brdf).items()
        if value.ndim == 1
    }
    ends = [(known[name].lower, known[name].upper) for name in own]
    return [
        replace(brdf, spectral | dict(zip(own, map(jnp.asarray, corner), strict=True)))
        for corner in itertools.product(*ends)
    ]


def stack(models: list[AbstractBRDF]) -> AbstractBRDF:
    """One model whose every array has the models along its first axis."""
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *models)
