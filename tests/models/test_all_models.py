"""Physics that every model of the registry obeys, or declares that it does not.

Each function of a model is compiled once and shared by all tests.
"""

import functools

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import MODELS, albedo
from brdffit.parameters import parameters, replace, values
from tests.sampling import (
    all_pairs,
    corner_directions,
    corner_models,
    generator,
    incident,
    random_directions,
    random_models,
    stack,
)

DRAWN = 15  # models
PAIRS = 7000  # for each, which makes more than 1e5
every_model = pytest.mark.parametrize("name", MODELS)

REFLECTANCES = {"albedo", "base", "diffuse", "specular", "f0"}

# affine in each of these alone, but not declared so: there are products among them, of
# diffuse and specular, and of metallic with base, specular and sheen
AFFINE_UNDECLARED = {
    "ashikhmin_shirley": {"diffuse", "specular"},
    "principled": {"base", "metallic", "specular", "sheen", "clearcoat"},
}


@jax.jit
@functools.partial(jax.vmap, in_axes=(0, None, None))
def evaluate(brdf, wi, wo):
    """Models ``(M,)`` and pairs ``(N, 3)`` to values ``(M, N, channel)``."""
    return jax.vmap(brdf)(wi, wo)


@functools.cache
def drawn(name):
    rng = generator(MODELS[name])
    models = random_models(MODELS[name], DRAWN, rng)
    return models, random_directions(rng, PAIRS), random_directions(rng, PAIRS)


@functools.cache
def values_of_drawn(name):
    """Values there and back."""
    models, wi, wo = drawn(name)
    brdf = stack(models)
    return (
        np.asarray(evaluate(brdf, wi, wo)),
        np.asarray(evaluate(brdf, wo, wi)),
    )


@every_model
def test_values_are_finite_and_not_negative(name):
    there, _ = values_of_drawn(name)
    assert np.all(np.isfinite(there))
    assert np.all(there >= 0)
    assert np.any(there > 0)


@every_model
def test_reciprocity_is_as_declared(name):
    there, back = values_of_drawn(name)
    # below this float32 has no digits left
    scale = np.maximum(np.maximum(there, back), 1e-30)
    difference = np.max(np.abs(there - back) / scale)
    if MODELS[name].reciprocal:
        assert difference <= 1e-6
    else:
        assert difference > 0.1


@every_model
def test_value_is_zero_at_and_below_the_horizon(name):
    models, wi, wo = drawn(name)
    brdf = stack(models)
    flat = wi.at[:, 2].set(0.0)
    under = wi.at[:, 2].multiply(-1.0)
    for dark in (flat, under):
        assert np.all(np.asarray(evaluate(brdf, dark, wo)) == 0)
        assert np.all(np.asarray(evaluate(brdf, wo, dark)) == 0)


@every_model
def test_one_pair_agrees_with_the_compiled_batch(name):
    models, wi, wo = drawn(name)
    there, _ = values_of_drawn(name)
    for i in (0, 1):
        alone = models[i](wi[i], wo[i])
        np.testing.assert_allclose(alone, there[i, i], rtol=2e-5, atol=1e-30)


@every_model
def test_isotropy_is_as_declared(name):
    models, wi, wo = drawn(name)
    turn = jnp.array([[0.8, 0.6, 0.0], [-0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
    there, _ = values_of_drawn(name)
    turned = np.asarray(evaluate(stack(models), wi @ turn, wo @ turn))
    change = np.max(np.abs(turned - there) / (np.maximum(turned, there) + 1e-6))
    assert (change < 0.05) == MODELS[name].isotropic, change


def furnace(model):
    """Models that absorb nothing: reflectances of a surface add to 1 in each channel.

    All of it goes to the first, half to each, all to the last.
    """
    rng = generator(model, salt=1)
    corners = corner_models(model)
    models = random_models(model, 8, rng) + corners[:: max(1, len(corners) // 8)]
    known = parameters(models[0])
    shares = [
        name
        for name, value in values(models[0]).items()
        if value.ndim == 1 and name.rpartition(".")[2] in REFLECTANCES
    ]
    assert all(known[name].upper == 1 for name in shares)
    split = {
        1: np.ones((1, 3)),
        2: np.array([[1.0, 0.5, 0.0], [0.0, 0.5, 1.0]]),
    }[len(shares)]
    white = dict(zip(shares, map(jnp.asarray, split), strict=True))
    return [replace(brdf, white) for brdf in models]


@jax.jit
def albedos(brdf, wi):
    """Directional albedo of models ``(M,)`` at directions ``(N, 3)``, one by one."""
    return jax.lax.map(
        lambda one: jax.lax.map(lambda w: albedo.directional_albedo(one, w), wi), brdf
    )


@every_model
def test_energy_conservation_is_as_declared(name, monkeypatch):
    """White furnace: no light comes back that was not sent."""
    # half the nodes: 1e-3 is all that is asked for
    monkeypatch.setattr(albedo, "NARROW", 64)
    monkeypatch.setattr(albedo, "WIDE", 24)
    angles = [(0, 0), (40, 90), (65, 20), (80, 0), (85, 90), (89, 45)]
    angles += [(89.99, 0), (89.99, 90)]
    with jax.enable_x64(True):
        brdf = stack(furnace(MODELS[name]))
        brdf = jax.tree.map(lambda leaf: jnp.asarray(leaf, jnp.float64), brdf)
        wi = jnp.asarray([incident(*angle) for angle in angles])
        highest = float(jnp.max(albedos(brdf, wi)))
    assert (highest <= 1 + 1e-3) == MODELS[name].energy_conserving, highest


@jax.jit
@functools.partial(jax.vmap, in_axes=(0, None, None))
@functools.partial(jax.vmap, in_axes=(None, 0, 0))
def derivatives(brdf, wi, wo):
    """Value, gradients backwards, and one derivative forwards along all arguments."""

    def total(brdf, wi, wo):
        return jnp.sum(brdf(wi, wo))

    arguments = (brdf, wi, wo)
    along = jax.tree.map(jnp.ones_like, arguments)
    return (
        jax.value_and_grad(total, argnums=(0, 1, 2))(*arguments),
        jax.jvp(total, arguments, along),
    )


@every_model
def test_derivatives_are_finite_at_all_corners(name):
    models = corner_models(MODELS[name])
    wi, wo = all_pairs(corner_directions())
    results = derivatives(stack(models), wi, wo)
    for leaf in jax.tree.leaves(results):
        bad = ~np.isfinite(np.asarray(leaf)).reshape(len(models), len(wi), -1).all(-1)
        if bad.any():
            i, j = np.argwhere(bad)[0]
            pytest.fail(f"{bad.sum()} bad; {values(models[i])} at {wi[j]} and {wo[j]}")


def bend(name, moved):
    """How far f_r is from affine in the named parameters together, between 0 and 1."""
    rng = generator(MODELS[name], salt=2)
    bends = []
    trios = []
    for brdf in random_models(MODELS[name], DRAWN // 3, rng):
        known = parameters(brdf)
        first, second = (
            {
                n: jnp.asarray(
                    rng.uniform(*known[n].typical, np.shape(values(brdf)[n]))
                )
                for n in moved
            }
            for _ in range(2)
        )
        middle = {n: (first[n] + second[n]) / 2 for n in moved}
        trios += [replace(brdf, new) for new in (first, second, middle)]
    _, wi, wo = drawn(name)
    f_r = np.asarray(evaluate(stack(trios), wi, wo), np.float64)
    for first, second, middle in zip(f_r[::3], f_r[1::3], f_r[2::3], strict=True):
        size = np.maximum(first, second) + 1e-30
        bends.append(np.max(np.abs(first + second - 2 * middle) / size))
    return max(bends)


@every_model
def test_linearity_is_as_declared(name):
    known = parameters(MODELS[name]())
    linear = [n for n, parameter in known.items() if parameter.linear]
    if linear:
        assert bend(name, linear) < 1e-5
    undeclared = {
        n for n in known if n not in linear and bend(name, [*linear, n]) < 1e-5
    }
    assert undeclared == AFFINE_UNDECLARED.get(name, set())
