import jax
import jax.numpy as jnp
import numpy as np

from brdffit.geometry import mirror
from brdffit.microfacet import ndf
from brdffit.models import Ward, WardBounded, WardDuer
from tests.sampling import incident, random_directions

LOBE = {"diffuse": [0.0], "specular": [1.0], "alpha_x": 0.2, "alpha_y": 0.5}


def pairs(count=50):
    rng = np.random.default_rng(0)
    return random_directions(rng, count), random_directions(rng, count)


def test_all_three_agree_along_the_normal():
    up = jnp.array([0.0, 0.0, 1.0])
    peak = 1 / (4 * np.pi * 0.2 * 0.5)
    for model in (Ward, WardDuer, WardBounded):
        assert np.allclose(model(**LOBE)(up, up), peak, rtol=1e-6)


def test_duer_divides_by_the_cosines_where_ward_divides_by_their_roots():
    wi, wo = pairs()
    ward, duer = (jax.vmap(m(**LOBE))(wi, wo)[:, 0] for m in (Ward, WardDuer))
    assert np.allclose(duer * jnp.sqrt(wi[:, 2] * wo[:, 2]), ward, rtol=1e-5)


def test_bounded_gloss_in_the_form_of_its_paper():
    wi, wo = pairs()
    found = jax.vmap(WardBounded(**LOBE))(wi, wo)[:, 0]
    alphas = jnp.asarray(0.2), jnp.asarray(0.5)
    lobe = jax.vmap(ndf.slope_gaussian, (0, None, None))(wi + wo, *alphas)
    between = jnp.sum(wi * wo, axis=1)
    expected = lobe / (jnp.pi * 0.2 * 0.5) * 2 * (1 + between)
    assert np.allclose(found, expected / (wi[:, 2] + wo[:, 2]) ** 4, rtol=2e-4)


def test_turning_the_tangent_swaps_the_roughnesses():
    wi, wo = pairs()
    turn = jnp.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    swapped = LOBE | {"alpha_x": 0.5, "alpha_y": 0.2}
    for model in (Ward, WardDuer, WardBounded):
        straight = jax.vmap(model(**LOBE))(wi, wo)
        turned = jax.vmap(model(**swapped))(wi @ turn, wo @ turn)
        assert np.allclose(straight, turned, rtol=1e-5)


def test_the_mirror_direction_tells_the_normalisations_apart():
    wi = jnp.asarray(incident(80), jnp.float32)
    ward, duer, bounded = (
        m(**LOBE)(wi, mirror(wi))[0] for m in (Ward, WardDuer, WardBounded)
    )
    assert np.isclose(duer, ward / wi[2], rtol=1e-5)
    assert np.isclose(bounded, duer, rtol=1e-5)
