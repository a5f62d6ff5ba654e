"""Many small fits find what single fits find, flag what cannot be found, and agree."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import brdffit
from brdffit.fit import texture
from brdffit.fit.texture import Texels, fit_texels
from brdffit.fit.transforms import Layout
from brdffit.parameters import replace, values
from brdffit.samples import Samples

OBSERVATIONS, NOISE = 24, 0.01
TRUTHS = {
    "ggx": {"diffuse": (0.1, 0.6), "f0": (0.1, 0.8), "alpha": (0.2, 0.5)},
    "conductor_ggx": {
        "specular": (1.0, 1.0),
        "alpha": (0.2, 0.4),
        "eta": (0.8, 2.0),
        "k": (1.0, 3.0),
    },
    "oren_nayar": {"albedo": (0.2, 0.8), "sigma": (0.2, 0.8)},
    "cook_torrance": {
        "diffuse": (0.3, 0.9),
        "specular": (0.3, 0.9),
        "f0": (0.3, 0.9),
        "alpha": (0.07, 0.3),
    },
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
    layout = Layout.of(brdffit.MODELS[model]())
    truth = {
        name: rng.uniform(*TRUTHS[model][name], (len(layout.places[name]), texels))
        for name, _ in layout.entries
    }
    blank = np.zeros((OBSERVATIONS, 3, texels), np.float32)
    made = remade(model, Texels(wi, wo, wi[:, 2:], blank), truth)
    scale = noise * np.median(made.value, axis=(0, 1))
    value = made.value + scale * rng.standard_normal(blank.shape)
    return dataclasses.replace(made, value=value.astype(np.float32)), truth


def remade(model, texels, truth):
    """The same directions with the exact values of these materials."""
    brdf = brdffit.MODELS[model]()
    shapes = {name: value.shape for name, value in values(brdf).items()}

    def f_r(truth, wi, wo):
        own = {name: value.reshape(shapes[name]) for name, value in truth.items()}
        return replace(brdf, own).evaluate(wi, wo)

    single = {name: jnp.asarray(v, jnp.float32) for name, v in truth.items()}
    over_observations = jax.vmap(jax.vmap(f_r, (1, 1, 1), 1), (None, 0, 0))
    value = np.asarray(over_observations(single, texels.wi, texels.wo)) * texels.weight
    return dataclasses.replace(texels, value=value)


@pytest.mark.parametrize("model", ["ggx", "oren_nayar"])
def test_truth_lies_within_the_errors(model):
    texels, truth = simulated(model, 200)
    found = fit_texels(model, texels, fixed=FIXED.get(model))
    assert np.mean(found.converged) > 0.95
    for name in truth.keys() - FIXED.get(model, {}).keys():
        error = found.standard_errors[name]
        known = found.converged & ~found.at_bound & np.isfinite(error)
        assert np.mean(known) > 0.8
        off = np.abs((found.parameters[name] - truth[name]) / error)[known]
        assert 0.5 < np.median(off) < 0.85
        assert np.mean(off > 5) < 0.02


def test_weight_and_f0_of_a_lobe_that_do_nearly_the_same_are_found():
    texels, truth = simulated("cook_torrance", 64)
    found = fit_texels("cook_torrance", texels)
    assert np.mean(found.converged) > 0.98
    best = remade("cook_torrance", texels, truth).value - texels.value
    least = np.sqrt(np.mean(best**2, axis=(0, 1)))
    assert np.all(found.rms < 1.001 * least)


def single_fit(model, texels, place):
    """The same texel by `brdffit.fit`."""
    wi, wo, weight, value = (
        array[..., place]
        for array in (texels.wi, texels.wo, texels.weight, texels.value)
    )
    samples = Samples(
        wi=wi[:, None],
        wo=wo,
        weight=np.repeat(weight, value.shape[1], axis=1)[:, None],
        cosine=np.ones(len(wi), np.float32),
        value=value,
    )
    return brdffit.fit(model, samples, fixed=FIXED.get(model))


@pytest.mark.parametrize("model", ["ggx", "oren_nayar"])
def test_single_fit_finds_the_same(model):
    texels, _ = simulated(model, 16)
    found = fit_texels(model, texels)
    for place in (3, 11):
        one = single_fit(model, texels, place)
        for name, value in one.parameters.items():
            error, own = (
                one.standard_errors[name],
                found.standard_errors[name][:, place],
            )
            known = np.isfinite(error) & np.isfinite(own)
            assert np.mean(known) > 0.6
            off = np.abs(found.parameters[name][:, place] - value) / error
            assert np.all(np.broadcast_to(off, own.shape)[known] < 0.1)
            np.testing.assert_allclose(
                own[known], np.broadcast_to(error, own.shape)[known], rtol=0.02
            )


def test_metal_with_an_index_in_each_channel():
    texels, truth = simulated("conductor_ggx", 16, noise=1e-4)
    fixed = {"specular": 1.0, "k": 2.0}
    truth["k"][:] = 2.0
    texels = remade("conductor_ggx", texels, truth)
    found = fit_texels("conductor_ggx", texels, fixed=fixed)
    good = found.converged & ~found.at_bound
    assert np.mean(good) > 0.7
    np.testing.assert_allclose(found.parameters["k"], 2.0)
    assert not found.standard_errors["k"].any()
    off = np.abs(found.parameters["alpha"] / truth["alpha"] - 1)[0, good]
    assert np.median(off) < 1e-3


def test_bounds_are_met_exactly():
    texels, truth = simulated("ggx", 16)
    truth["f0"][1] = 0.0
    texels = remade("ggx", texels, truth)
    darker = dataclasses.replace(texels, value=texels.value * [[[1], [0.97], [1]]])
    found = fit_texels("ggx", darker)
    on_bound = found.parameters["f0"][1] == 0
    assert 0.2 < np.mean(on_bound)
    assert np.all(found.at_bound[on_bound])
    assert min(found.parameters["f0"].min(), found.parameters["diffuse"].min()) >= 0


def test_what_cannot_be_found_is_flagged():
    texels, _ = simulated("ggx", 6)
    mask = np.ones((OBSERVATIONS, 1, 6), bool)
    mask[:, :, 0] = False
    mask[2:, :, 1] = False  # six values for seven unknowns
    value, weight = texels.value.copy(), texels.weight.copy()
    value[..., 2] = 0
    weight[..., 3] = 0
    value[0, 0, 4] = np.nan
    found = fit_texels(
        "ggx", dataclasses.replace(texels, value=value, weight=weight, mask=mask)
    )
    assert found.converged.tolist() == [False, False, True, False, True, True]
    for name, parameter in found.parameters.items():
        assert np.all(np.isfinite(parameter))
        error = found.standard_errors[name]
        assert np.all(np.isinf(error[:, [0, 1, 3]]))
        assert np.all(np.isfinite(error[:, 5]))
    assert np.all(np.isfinite(found.rms))
    np.testing.assert_array_equal(found.parameters["diffuse"][:, 2], 0)


def test_neighbours_and_chunks_do_not_matter():
    texels, _ = simulated("ggx", 37)
    whole = fit_texels("ggx", texels)
    arrays = ("wi", "wo", "weight", "value")
    for part in (slice(0, 5), slice(5, 37)):
        cut = Texels(*(getattr(texels, name)[..., part] for name in arrays))
        found = fit_texels("ggx", cut, threads=1)
        for name, value in found.parameters.items():
            np.testing.assert_array_equal(value, whole.parameters[name][:, part])
        np.testing.assert_array_equal(found.converged, whole.converged[part])


def test_directions_that_all_texels_share():
    texels, _ = simulated("ggx", 16)
    shared = dataclasses.replace(texels, wi=texels.wi[..., :1], wo=texels.wo[..., :1])
    repeated = dataclasses.replace(
        texels, **{n: np.repeat(getattr(shared, n), 16, axis=2) for n in ("wi", "wo")}
    )
    for name, value in fit_texels("ggx", shared).parameters.items():
        expected = fit_texels("ggx", repeated).parameters[name]
        np.testing.assert_allclose(value, expected, rtol=2e-3, atol=2e-4)


def test_other_residuals_solve_all_parameters_together():
    texels, truth = simulated("ggx", 16, noise=1e-3)
    found = fit_texels("ggx", texels, residual="log")
    good = found.converged & ~found.at_bound
    assert np.mean(good) > 0.8
    off = np.abs(found.parameters["alpha"] / truth["alpha"] - 1)[0, good]
    assert np.median(off) < 5e-3


def test_shapes_that_do_not_fit_are_refused():
    texels, _ = simulated("ggx", 4)
    with pytest.raises(ValueError, match=r"`wo` must have the shape \(24, 3, 1 or 4\)"):
        dataclasses.replace(texels, wo=texels.wo[..., :3])
    with pytest.raises(ValueError, match="must have the 3 channels"):
        fit_texels(brdffit.catalogue.from_name("ggx", 1), texels)
