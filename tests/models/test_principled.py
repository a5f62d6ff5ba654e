import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models import GGXLobe, Principled
from tests.sampling import random_directions


def pairs():
    rng = np.random.default_rng(0)
    return random_directions(rng, 30), random_directions(rng, 30)


def test_a_metal_is_a_lobe_of_its_colour():
    wi, wo = pairs()
    metal = Principled(base=[0.9, 0.5, 0.2], metallic=1.0, roughness=0.5, sheen=0.5)
    lobe = GGXLobe(f0=[0.9, 0.5, 0.2], alpha=0.25)
    assert np.allclose(jax.vmap(metal)(wi, wo), jax.vmap(lobe)(wi, wo), rtol=1e-5)


def test_the_dielectric_gloss_has_no_colour():
    wi = jnp.array([0.6, 0.0, 0.8])
    wo = jnp.array([-0.6, 0.0, 0.8])
    black = Principled(base=[0.0], roughness=0.2, specular=1.0)(wi, wo)
    assert np.allclose(black, GGXLobe(f0=[0.08], alpha=0.04)(wi, wo), rtol=1e-5)


def test_roughness_ends_before_a_mirror():
    up = jnp.array([0.0, 0.0, 1.0])
    smooth, almost = (Principled(roughness=r)(up, up) for r in (0.0, 0.03))
    assert np.all(np.isfinite(smooth))
    assert np.array_equal(smooth, almost)


def test_a_rough_base_is_retroreflective():
    grazing = jnp.array([0.995, 0.0, 0.0998749])
    base = {"base": [0.5], "specular": 0.0}
    smooth, rough = (Principled(**base, roughness=r) for r in (0.1, 1.0))
    assert rough(grazing, grazing)[0] > 0.5 / np.pi > smooth(grazing, grazing)[0]


def test_sheen_and_coat_add_to_the_rest():
    wi, wo = pairs()
    plain, sheen, coat = (
        jax.vmap(Principled(sheen=s, clearcoat=c, clearcoat_gloss=0.3))(wi, wo)
        for s, c in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    )
    assert np.all(sheen >= plain)
    assert np.all(coat >= plain)
    # sheen at grazing differences of angle, the coat about the mirror direction
    assert np.max(sheen - plain) > 0.1
    assert np.max(coat - plain) > 0.01
