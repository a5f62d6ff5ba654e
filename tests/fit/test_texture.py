"""Many small fits find what single fits find, flag what cannot be found, and agree."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import brdffit
from brdffit.fit import texture
from brdffit.fit.texture import Texels, fit_texels
from brdffit.fit.transforms import Layout
from brdffit.parameters import replace, values

OBSERVATIONS, NOISE = 32, 0.01
TRUTHS = {
    "ggx": {"diffuse": (0.1, 0.6), "f0": (0.1, 0.8), "alpha": (0.2, 0.5)},
    "cook_torrance": {
        "diffuse": (0.1, 0.6),
        "specular": (0.4, 0.8),
        "f0": (0.2, 0.6),
        "alpha": (0.2, 0.4),
    },
    "conductor_ggx": {
        "specular": (1.0, 1.0),
        "alpha": (0.2, 0.4),
        "eta": (0.8, 2.0),
        "k": (1.0, 3.0),
    },
    "oren_nayar": {"albedo": (0.2, 0.8), "sigma": (0.2, 0.8)},
}
FIXED = {"conductor_ggx": {"specular": 1.0}}


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch):
    """Several blocks from few texels."""
    monkeypatch.setattr(texture, "SIZE", 16)


def upward(rng, count, texels):
    z, phi = rng.uniform(0.2, 1, (2, count, texels)) * [[[1]], [[2 * np.pi]]]
    radius = np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=1)


def simulated(model, texels, noise=NOISE, seed=0):
    """Texels of random materials, and their parameters."""
    rng = np.random.default_rng(seed)
    wi, wo = (upward(rng, OBSERVATIONS, texels).astype(np.float32) for _ in range(2))
    brdf = brdffit.MODELS[model]()
    layout = Layout.of(brdf)
    truth = {
        name: rng.uniform(*TRUTHS[model][name], (len(layout.places[name]), texels))
        for name, _ in layout.entries
    }
    shapes = {name: value.shape for name, value in values(brdf).items()}

    def f_r(truth, wi, wo):
        own = {name: value.reshape(shapes[name]) for name, value in truth.items()}
        return replace(brdf, own).evaluate(wi, wo)

    over_texels = jax.vmap(f_r, (1, 1, 1), 1)
    exact = jax.vmap(over_texels, (None, 0, 0))(
        {name: jnp.asarray(v, jnp.float32) for name, v in truth.items()}, wi, wo
    )
    exact = np.asarray(exact) * wi[:, 2:]
    scale = noise * np.median(exact, axis=(0, 1))
    value = exact + scale * rng.standard_normal(exact.shape)
    return Texels(wi, wo, wi[:, 2:], value.astype(np.float32)), truth


@pytest.mark.parametrize("model", ["ggx", "oren_nayar"])
def test_truth_lies_within_the_errors(model):
    texels, truth = simulated(model, 40)
    found = fit_texels(model, texels, fixed=FIXED.get(model))
    assert np.mean(found.converged) > 0.95
    for name in truth.keys() - FIXED.get(model, {}).keys():
        error = found.standard_errors[name]
        known = found.converged & ~found.at_bound & np.isfinite(error)
        assert np.mean(known) > 0.8
        off = np.abs((found.parameters[name] - truth[name]) / error)[known]
        assert 0.5 < np.median(off) < 0.85
        assert np.mean(off > 5) < 0.02
