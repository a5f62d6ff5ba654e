import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.albedo import directional_albedo
from brdffit.microfacet import fresnel
from brdffit.models import PlasticGGX
from tests.sampling import incident

WI, WO = jnp.array([0.6, 0.0, 0.8]), jnp.array([0.3, 0.4, 0.866025])


def test_without_a_contrast_of_indices_there_is_no_coat():
    value = PlasticGGX(diffuse=[0.7], alpha=0.3, eta=1.0)(WI, WO)
    assert np.isclose(value[0], 0.7 / np.pi, rtol=1e-5)


# closed form of Walsh 1926 and Duntley 1942
@pytest.mark.parametrize(
    ("eta", "inside"), [(1.01, 0.0227883), (1.5, 0.5963458), (3.0, 0.9195782)]
)
def test_diffuse_light_inside_is_reflected_as_published(eta, inside):
    entering = fresnel.diffuse_transmittance(jnp.asarray(eta))
    assert np.isclose(1 - entering / eta**2, inside, atol=1e-6)


def test_transmittance_is_what_is_not_reflected():
    for cosine in (1.0, 0.5, 0.05):
        cosine, eta = jnp.asarray(cosine), jnp.asarray(1.5)
        through = fresnel.dielectric_transmittance(cosine, eta)
        assert np.isclose(through, 1 - fresnel.dielectric(cosine, eta), rtol=1e-5)


def test_transmittance_keeps_its_digits_at_grazing():
    through = fresnel.dielectric_transmittance(jnp.asarray(1e-6), jnp.asarray(1.5))
    # 2 c (1 + n^2) / sqrt(n^2 - 1) to first order, of both polarisations
    expected = 2e-6 * (1 + 1.5**2) / np.sqrt(1.25)
    assert np.isclose(through, expected, rtol=1e-4)


def test_interreflection_saturates_colours():
    value = PlasticGGX(diffuse=[0.9, 0.3, 0.0], alpha=0.05, eta=1.5)(WI, WO)
    base = value - value[2]
    assert base[0] / base[1] > 1.5 * 0.9 / 0.3


def test_energy_is_exceeded_by_no_more_than_stated():
    degrees, alphas, etas = (30, 50, 70), (0.05, 0.1, 0.2), (1.1, 1.25, 1.5)
    wi = jnp.asarray([incident(a) for a in degrees], jnp.float32)

    @jax.jit
    def reflected(alpha, eta):
        white = PlasticGGX(diffuse=[1.0], alpha=alpha, eta=eta)
        return jax.lax.map(lambda w: directional_albedo(white, w)[0], wi)

    found = np.array([[reflected(alpha, eta) for eta in etas] for alpha in alphas])
    assert np.unravel_index(found.argmax(), found.shape) == (1, 1, 1)
    assert np.isclose(found.max(), 1.00073, atol=1e-5)
