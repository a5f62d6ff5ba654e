import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.albedo import directional_albedo
from brdffit.geometry import mirror
from brdffit.models import Eon, Lambert
from tests.sampling import incident, random_directions


def test_a_smooth_surface_is_lambertian():
    rng = np.random.default_rng(0)
    wi, wo = random_directions(rng, 20), random_directions(rng, 20)
    smooth = Eon(albedo=[0.8, 0.4, 0.1], roughness=0.0)
    plain = Lambert(albedo=[0.8, 0.4, 0.1])
    assert np.allclose(jax.vmap(smooth)(wi, wo), jax.vmap(plain)(wi, wo), rtol=1e-6)


@jax.jit
def albedos(brdf, wi):
    return jax.lax.map(lambda w: directional_albedo(brdf, w), wi)


@pytest.mark.parametrize("roughness", [0.01, 0.3, 1.0])
def test_a_white_surface_loses_nothing_at_any_angle(roughness):
    white = Eon(albedo=[1.0], roughness=roughness)
    angles = [0, 30, 60, 80, 89, 89.99]
    wi = jnp.asarray([incident(a) for a in angles], jnp.float32)
    found = albedos(white, wi)
    assert np.allclose(found, 1, atol=1e-4)


def test_colours_saturate_as_light_bounces_more_often():
    wi, wo = jnp.array([0.6, 0.0, 0.8]), jnp.array([0.0, 0.6, 0.8])
    value = Eon(albedo=[0.9, 0.3], roughness=1.0)(wi, wo)
    assert value[0] / value[1] > 0.9 / 0.3


def test_light_that_grazes_towards_the_viewer_is_not_negative():
    """1 + s of the first term vanishes there."""
    angle = jnp.linspace(0.0, 3.0, 500)
    flat = jnp.stack([jnp.cos(angle), jnp.sin(angle), jnp.full(500, 1e-6)], axis=1)
    dark = Eon(albedo=[0.001], roughness=1.0)
    value = jax.vmap(dark)(flat, jax.vmap(mirror)(flat))
    assert np.all(value >= 0)
