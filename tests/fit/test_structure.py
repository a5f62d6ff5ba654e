"""The normal equations agree with the plain residual and its dense Jacobian."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.fit import structure
from brdffit.fit.blocks import blocks, usable
from brdffit.fit.conditions import bounded_problem
from brdffit.fit.residual import RESIDUALS
from brdffit.fit.transforms import Layout, bounds, pack, to_natural, to_solver, unpack
from brdffit.models import MODELS
from brdffit.render.shading import shade
from brdffit.samples import Samples

COUNT, LIGHTS, CHANNELS = 40, 2, 3


def upward(rng, count):
    """Directions uniform in solid angle, somewhat above the horizon."""
    z, phi = rng.uniform(0.1, 1, count), rng.uniform(0, 2 * np.pi, count)
    radius = np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=1)


@pytest.fixture(scope="module")
def samples() -> Samples:
    """Noise seen under two coloured lights, with weights that differ by channel."""
    rng = np.random.default_rng(3)
    return Samples(
        wi=upward(rng, COUNT * LIGHTS).reshape(COUNT, LIGHTS, 3),
        wo=upward(rng, COUNT),
        weight=rng.uniform(0.2, 1, (COUNT, LIGHTS, CHANNELS)),
        cosine=rng.uniform(0.2, 1, COUNT),
        value=rng.uniform(0.2, 1.2, (COUNT, CHANNELS)),
        sigma=rng.uniform(0.1, 1.1, (COUNT, CHANNELS)),
        mask=rng.uniform(size=(COUNT, CHANNELS)) > 0.1,
    )


def middle(model):
    """A model away from all its bounds, with differing channels."""
    brdf = model()
    layout = Layout.of(brdf)
    low = to_solver(layout, np.array([p.typical[0] for p in layout.known]))
    high = to_solver(layout, np.array([p.typical[1] for p in layout.known]))
    share = np.linspace(0.35, 0.55, len(low))
    return brdf, layout, low + share * (high - low)


def plain_residual(brdf, layout, samples, residual):
    """The residual as anyone would write it, a function of solver coordinates."""
    use = usable(samples, residual)
    cosines = jnp.asarray(samples.cosine)[:, None], jnp.asarray(samples.wo)[:, 2:]

    def transform(value):
        return residual.transform(value, *cosines)

    # the error of y, carried through the transform
    y = jnp.asarray(samples.value)
    sigma = samples.sigma * jax.jvp(transform, (y,), (jnp.ones_like(y),))[1]
    scale = jnp.where(use, 1 / sigma, 0)

    def residuals(x):
        natural = to_natural(layout, x, tuple(range(x.shape[0])))
        predicted = shade(unpack(layout, brdf, natural), samples)
        return (scale * (transform(predicted) - transform(y))).ravel()

    return residuals


@pytest.mark.parametrize(
    ("name", "residual"),
    [(name, "log") for name in MODELS]
    + [(name, "cosine_weighted") for name in ("phong", "conductor_ggx", "sum")],
)
def test_streamed_equations_are_those_of_the_dense_jacobian(name, residual, samples):
    residual = RESIDUALS[residual]
    with jax.enable_x64(True):
        brdf, layout, x = middle(MODELS[name])
        data = blocks(samples, usable(samples, residual), residual, np.dtype(float))
        problem = bounded_problem(layout, brdf, residual, {})(blocks=data)
        found = jax.jit(structure.stream)(problem, jnp.asarray(x))
        residuals = plain_residual(brdf, layout, samples, residual)
        r, jacobian = jax.jit(lambda x: (residuals(x), jax.jacfwd(residuals)(x)))(x)
        close = {"rtol": 1e-5, "atol": 1e-5 * np.abs(jacobian.T @ jacobian).max()}
        np.testing.assert_allclose(found.cost, r @ r / 2, rtol=1e-6)
        np.testing.assert_allclose(found.gradient, jacobian.T @ r, **close)
        np.testing.assert_allclose(found.hessian, jacobian.T @ jacobian, **close)


@pytest.mark.parametrize("name", MODELS)
def test_projection_eliminates_the_linear_parameters(name, samples):
    """At the projected optimum no linear parameter can lower the streamed cost."""
    residual = RESIDUALS["cosine_weighted"]
    with jax.enable_x64(True):
        brdf, layout, x = middle(MODELS[name])
        data = blocks(samples, usable(samples, residual), residual, np.dtype(float))
        problem = bounded_problem(layout, brdf, residual, {})(blocks=data)
        nonlinear = problem.nonlinear_places
        projected, linear = jax.jit(structure.project)(
            problem, jnp.asarray(x[nonlinear])
        )
        places = layout.channel_places(layout.linear)
        x = jnp.asarray(x).at[places].set(linear)
        whole = jax.jit(structure.stream)(problem, x)
        lower, upper = bounds(layout)
        np.testing.assert_allclose(projected.cost, whole.cost, rtol=1e-9)
        for place in places.ravel():
            slope = whole.gradient[place] / np.sqrt(whole.hessian[place, place])
            inside = (x[place] > lower[place]) & (x[place] < upper[place])
            outward = slope > 0 if x[place] <= lower[place] else slope < 0
            assert abs(slope) < 1e-6 if inside else outward

        # the gradient of the reduced cost, and the Schur complement of the whole
        free = [p for p in places.ravel() if lower[p] < x[p] < upper[p]]
        scale = np.abs(whole.gradient).max() + 1e-12
        np.testing.assert_allclose(
            projected.gradient, whole.gradient[nonlinear], atol=1e-7 * scale
        )
        hessian = np.asarray(whole.hessian)
        cross = hessian[np.ix_(nonlinear, free)]
        within = hessian[np.ix_(free, free)]
        schur = hessian[np.ix_(nonlinear, nonlinear)]
        if free:
            schur = schur - cross @ np.linalg.solve(within, cross.T)
        np.testing.assert_allclose(
            projected.hessian, schur, atol=1e-6 * np.abs(hessian).max()
        )


def test_layout_of_a_sum_names_the_parts():
    layout = Layout.of(MODELS["sum"]())
    assert layout.channels == CHANNELS
    assert all("." in label for label in layout.labels)
    assert len(layout.labels) == len(pack(layout, MODELS["sum"]()))


def test_values_of_no_use_change_nothing(samples):
    """Masked values may be anything: they do not reach the equations."""
    residual = RESIDUALS["cosine_weighted"]
    spoiled = dataclasses.replace(
        samples, value=np.where(samples.mask, samples.value, np.nan)
    )
    with jax.enable_x64(True):
        brdf, layout, x = middle(MODELS["phong"])
        costs = []
        for data in (samples, spoiled):
            laid = blocks(data, usable(data, residual), residual, np.dtype(float))
            problem = bounded_problem(layout, brdf, residual, {})(blocks=laid)
            costs.append(float(structure.stream(problem, jnp.asarray(x)).cost))
    assert costs[0] == costs[1]
