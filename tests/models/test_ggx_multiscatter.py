import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.albedo import directional_albedo
from brdffit.models import GGX, GGXMultiscatter
from tests.sampling import incident, random_directions


@jax.jit
def albedos(brdf, wi):
    return jax.lax.map(lambda w: directional_albedo(brdf, w), wi)


@pytest.mark.parametrize("alpha", [1e-4, 1e-3, 0.02, 0.3, 1.0])
def test_a_white_metal_loses_nothing_at_any_angle(alpha):
    white = GGXMultiscatter(diffuse=[0.0], f0=[1.0], alpha=alpha)
    wi = jnp.asarray([incident(a) for a in (0, 40, 70, 85, 89.9, 89.99)], jnp.float32)
    found = albedos(white, wi)
    assert np.allclose(found, 1, atol=5e-5)


def test_light_is_added_to_single_scattering_in_all_directions():
    rng = np.random.default_rng(0)
    wi, wo = random_directions(rng, 50), random_directions(rng, 50)
    given = {"diffuse": [0.2], "f0": [0.9], "alpha": 0.7}
    once, again = (jax.vmap(m(**given))(wi, wo) for m in (GGX, GGXMultiscatter))
    assert np.all(again > once)
    assert np.max(again - once) < 0.5


def test_colours_saturate_with_roughness():
    wi, wo = jnp.array([0.6, 0.0, 0.8]), jnp.array([0.0, 0.6, 0.8])
    given = {"diffuse": [0.0, 0.0], "f0": [0.9, 0.4], "alpha": 1.0}
    once, again = GGX(**given)(wi, wo), GGXMultiscatter(**given)(wi, wo)
    extra = again - once
    assert extra[0] / extra[1] > (0.9 / 0.4) ** 2
