import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.fit.loss import LOSSES

SQUARES = jnp.geomspace(1e-6, 1e6, 41)


@pytest.mark.parametrize("name", LOSSES)
def test_the_weight_is_the_derivative(name):
    loss = LOSSES[name]
    slope = jax.vmap(jax.grad(loss.rho))(SQUARES)
    np.testing.assert_allclose(slope, loss.weight(SQUARES), rtol=1e-5)


@pytest.mark.parametrize("name", LOSSES)
def test_small_residuals_count_as_squares_and_large_ones_for_less(name):
    rho = np.asarray(LOSSES[name].rho(SQUARES))
    np.testing.assert_allclose(rho[:10], SQUARES[:10], rtol=1e-3)
    assert np.all(np.diff(rho / SQUARES) <= 1e-6)
    assert rho[-1] < 0.01 * SQUARES[-1]


@pytest.mark.parametrize("name", LOSSES)
def test_the_constants_cost_five_percent_on_normal_noise(name):
    """Efficiency ``E[psi']^2 / E[psi^2]``, integrated over the normal density."""
    u = np.linspace(-12, 12, 200_001)
    density = np.exp(-(u**2) / 2) / np.sqrt(2 * np.pi)
    with jax.enable_x64(True):
        psi = np.asarray(u * LOSSES[name].weight(jnp.asarray(u**2)))
    slope = np.gradient(psi, u)
    step = u[1] - u[0]
    efficiency = (np.sum(slope * density) * step) ** 2 / (
        np.sum(psi**2 * density) * step
    )
    assert efficiency == pytest.approx(0.95, abs=1e-3)
