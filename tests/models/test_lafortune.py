import jax
import jax.numpy as jnp
import numpy as np

from brdffit.geometry import mirror
from brdffit.models import Lafortune, Phong
from tests.sampling import random_directions

LOBE = {"diffuse": [0.0], "specular": [1.0]}


def test_opposite_coefficients_of_one_are_the_phong_lobe():
    rng = np.random.default_rng(0)
    wi, wo = random_directions(rng, 50), random_directions(rng, 50)
    lobe = Lafortune(**LOBE, c_x=-1.0, c_y=-1.0, c_z=1.0, exponent=40.0)
    phong = Phong(**LOBE, exponent=40.0)
    peak = (40 + 2) / (2 * np.pi)
    assert np.allclose(
        jax.vmap(lobe)(wi, wo) * peak, jax.vmap(phong)(wi, wo), rtol=1e-5
    )


def test_positive_coefficients_reflect_back_to_the_light():
    wi = jnp.array([0.6, 0.0, 0.8])
    retro = Lafortune(**LOBE, c_x=1.0, c_y=1.0, c_z=1.0, exponent=50.0)
    assert np.isclose(retro(wi, wi)[0], 1.0, rtol=1e-6)
    assert retro(wi, mirror(wi))[0] < 1e-6


def test_a_small_normal_coefficient_leans_towards_grazing():
    wi = jnp.array([-0.6, 0.0, 0.8])
    lobe = Lafortune(**LOBE, c_x=-1.0, c_y=-1.0, c_z=0.6, exponent=50.0)
    theta = jnp.linspace(0.1, 1.5, 400)
    wo = jnp.stack([jnp.sin(theta), 0 * theta, jnp.cos(theta)], axis=1)
    highest = theta[jnp.argmax(jax.jit(jax.vmap(lobe, (None, 0)))(wi, wo)[:, 0])]
    # along (C_x x, C_y y, C_z z)
    assert np.isclose(highest, np.arctan2(0.6, 0.6 * 0.8), atol=0.01)


def test_a_lobe_beyond_all_numbers_stays_finite():
    lobe = Lafortune(**LOBE, c_x=2.0, c_y=2.0, c_z=2.0, exponent=1e5)
    up = jnp.array([0.0, 0.0, 1.0])
    value, gradient = jax.value_and_grad(lambda b: b(up, up)[0])(lobe)
    assert 1e33 < value < np.inf
    assert all(np.all(np.isfinite(g)) for g in jax.tree.leaves(gradient))
