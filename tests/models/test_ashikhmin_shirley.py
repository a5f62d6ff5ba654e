import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models import AshikhminShirley
from tests.sampling import random_directions


def test_the_base_gets_what_the_gloss_leaves():
    wi, wo = jnp.array([0.8, 0.0, 0.6]), jnp.array([0.8, 0.0, 0.6])
    value = AshikhminShirley(
        diffuse=[1.0, 1.0], specular=[0.0, 1.0], exponent_u=1e4, exponent_v=1e4
    )(wi, wo)
    bend = 1 - (1 - 0.3) ** 5
    assert np.allclose(value, [28 / (23 * np.pi) * bend**2, 0.0], atol=1e-6)


def test_equal_exponents_are_isotropic_and_swapped_ones_turn():
    rng = np.random.default_rng(0)
    wi, wo = random_directions(rng, 30), random_directions(rng, 30)
    turn = jnp.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])

    def values(u, v, wi, wo):
        return jax.vmap(AshikhminShirley(exponent_u=u, exponent_v=v))(wi, wo)

    for u, v in ((100.0, 100.0), (10.0, 300.0)):
        straight = values(u, v, wi, wo)
        assert np.allclose(straight, values(v, u, wi @ turn, wo @ turn), rtol=1e-5)


def test_the_peak_is_that_of_the_paper():
    up = jnp.array([0.0, 0.0, 1.0])
    gloss = AshikhminShirley(
        diffuse=[0.0], specular=[0.3], exponent_u=8.0, exponent_v=99.0
    )
    assert np.isclose(gloss(up, up)[0], 0.3 * np.sqrt(9 * 100) / (8 * np.pi), rtol=1e-6)
