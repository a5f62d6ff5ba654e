import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models import Banks
from tests.sampling import random_directions

FIBRE = Banks(diffuse=[0.0], specular=[1.0], exponent=20.0)


def test_a_fibre_reflects_into_a_cone_about_itself():
    """The value does not change when the viewer turns about the tangent."""
    wi = jnp.array([0.5, 0.1, 0.86])
    wi = wi / jnp.linalg.norm(wi)
    angle = jnp.linspace(0.3, 2.8, 20)
    along, across = -0.45, np.sqrt(1 - 0.45**2)
    wo = jnp.stack(
        [jnp.full(20, along), across * jnp.cos(angle), across * jnp.sin(angle)], axis=1
    )
    found = jax.vmap(FIBRE, (None, 0))(wi, wo)
    assert np.allclose(found, found[0], rtol=1e-5)


def test_light_across_the_fibre_falls_off_as_a_power_of_the_sine():
    rng = np.random.default_rng(0)
    wo = random_directions(rng, 30)
    wi = jnp.array([0.0, 0.6, 0.8])
    sine = jnp.sqrt(1 - wo[:, 0] ** 2)
    found = jax.vmap(FIBRE, (None, 0))(wi, wo)[:, 0]
    assert np.allclose(found, sine**20, rtol=1e-4)


def test_the_lobe_ends_at_a_right_angle_from_the_cone():
    wi = jnp.array([0.8, 0.0, 0.6])
    wo = jnp.array([0.8, 0.0, 0.6])
    assert FIBRE(wi, wo) == 0
