import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models import Lambert, OrenNayar, OrenNayarFull
from tests.sampling import random_directions


def pairs():
    rng = np.random.default_rng(0)
    return random_directions(rng, 30), random_directions(rng, 30)


def test_a_smooth_surface_is_lambertian():
    wi, wo = pairs()
    smooth, plain = OrenNayarFull(albedo=0.7, sigma=0.0), Lambert(albedo=0.7)
    assert np.allclose(jax.vmap(smooth)(wi, wo), jax.vmap(plain)(wi, wo), rtol=1e-6)


def test_interreflection_adds_to_the_qualitative_model_at_the_normal():
    up = jnp.array([0.0, 0.0, 1.0])
    variance = 0.4**2
    full, simple = (
        m(albedo=[0.6], sigma=0.4)(up, up)[0] for m in (OrenNayarFull, OrenNayar)
    )
    added = 0.17 * 0.6**2 / np.pi * variance / (variance + 0.13)
    assert np.isclose(full - simple, added, rtol=1e-5)


def test_retro_direction_is_brighter_than_the_mirror_direction():
    wi = jnp.array([0.8, 0.0, 0.6])
    brdf = OrenNayarFull(albedo=[0.8], sigma=0.5)
    assert brdf(wi, wi) > 1.5 * brdf(wi, jnp.array([-0.8, 0.0, 0.6]))


def test_the_normal_has_a_gradient():
    """Azimuth is undefined there, but the value is smooth."""
    up, wo = jnp.array([0.0, 0.0, 1.0]), jnp.array([0.6, 0.0, 0.8])
    brdf = OrenNayarFull(albedo=[1.0], sigma=0.5)
    slope = jax.grad(lambda wi: brdf(wi, wo)[0])(up)[0]
    step = 1e-3
    sides = [brdf(jnp.array([s, 0.0, 1.0]), wo)[0] for s in (step, -step)]
    assert np.isclose(slope, (sides[0] - sides[1]) / (2 * step), rtol=1e-2)
