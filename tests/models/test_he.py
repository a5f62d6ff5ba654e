import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.albedo import directional_albedo
from brdffit.models import ConductorBeckmann, He
from brdffit.parameters import parameters
from tests.sampling import incident, random_directions

# almost a perfect conductor
WHITE = {"eta": [0.01], "k": [20.0], "diffuse": [0.0]}


def test_a_very_rough_surface_is_a_beckmann_surface():
    rng = np.random.default_rng(0)
    wi, wo = random_directions(rng, 200), random_directions(rng, 200)
    steep = (wi[:, 2] > 0.4) & (wo[:, 2] > 0.4)
    rough = He(sigma0=20.0, tau=200.0, eta=0.8, k=5.0, diffuse=0.0, wavelengths=0.5)
    facets = ConductorBeckmann(specular=1.0, alpha=0.2, eta=0.8, k=5.0, separable=True)
    found, expected = (jax.jit(jax.vmap(m))(wi, wo) for m in (rough, facets))
    visible = np.asarray(steep)[:, None] & (np.asarray(expected) > 1e-3)
    assert visible.sum() > 30
    assert np.allclose(found[visible], expected[visible], rtol=2e-3)


@jax.jit
def energy(brdf, wi):
    return directional_albedo(brdf, wi) + brdf.specular_reflectance(wi)


# directional albedo of lobe and mirror image, as worked out with many digits
@pytest.mark.parametrize(
    ("sigma0", "tau", "wavelength", "degrees", "whole"),
    [
        (0.05, 3.0, 0.5, 0, 1.0000),
        (0.05, 3.0, 0.5, 80, 1.0053),
        (0.18, 3.0, 0.5, 60, 0.9915),
        (0.28, 1.77, 0.5, 60, 0.8824),
        (2.0, 5.0, 0.4, 0, 0.5488),
        (0.01, 0.1, 0.4, 60, 1.0108),
    ],
)
def test_lobe_and_mirror_image_share_the_light(sigma0, tau, wavelength, degrees, whole):
    brdf = He(sigma0=sigma0, tau=tau, **WHITE, wavelengths=wavelength)
    wi = jnp.asarray(incident(degrees), jnp.float32)
    assert np.isclose(energy(brdf, wi)[0], whole, atol=1e-3)


def test_a_smooth_surface_is_a_mirror():
    brdf = He(sigma0=1e-4, tau=5.0, eta=0.5, k=3.0, diffuse=0.0)
    up = jnp.array([0.0, 0.0, 1.0])
    f0 = ((0.5 - 1) ** 2 + 9) / ((0.5 + 1) ** 2 + 9)
    assert np.allclose(brdf.specular_reflectance(up), f0, rtol=1e-4)


def test_blue_light_sees_a_rougher_surface_than_red():
    brdf = He(sigma0=0.05, tau=3.0, eta=0.01, k=20.0, wavelengths=[0.65, 0.45])
    red, blue = brdf.specular_reflectance(jnp.array([0.6, 0.0, 0.8]))
    assert red > 1.2 * blue


def test_wavelengths_are_given_and_not_fitted():
    brdf = He(eta=[0.5, 0.6], k=3.0, wavelengths=[0.6, 0.5])
    assert "wavelengths" not in parameters(brdf)
    assert brdf.channels == 2
    assert np.allclose(He(eta=[0.5, 0.6]).wavelengths, 0.55)
    with pytest.raises(ValueError, match="same number of channels"):
        He(eta=[0.5, 0.6], wavelengths=[0.6, 0.5, 0.4])
