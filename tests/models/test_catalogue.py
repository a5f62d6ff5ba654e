"""The catalogue of models: parameters in their order, by their names and roles.

S marks one value per channel, s one value in all, L a parameter in which f_r is affine.
"""

import pytest

from brdffit import MODELS
from brdffit.parameters import parameters

FACETS = "specular SL, alpha s"
WARD = "diffuse SL, specular SL, alpha_x s, alpha_y s"
TWO = "diffuse SL, specular SL, exponent s"
GGX = "diffuse SL, f0 SL, alpha s"

CATALOGUE = {
    "lambert": "albedo SL",
    "phong_original": TWO,
    "phong": TWO,
    "blinn_phong_original": TWO,
    "blinn_phong": TWO,
    "oren_nayar": "albedo SL, sigma s",
    "oren_nayar_full": "albedo S, sigma s",
    "eon": "albedo S, roughness s",
    "conductor_ggx": f"{FACETS}, eta S, k S",
    "conductor_beckmann": f"{FACETS}, eta S, k S",
    "dielectric_ggx": f"{FACETS}, eta s",
    "dielectric_beckmann": f"{FACETS}, eta s",
    "cook_torrance": "diffuse SL, specular SL, f0 s, alpha s",
    "ggx": GGX,
    "beckmann": GGX,
    "ggx_lobe": "f0 SL, alpha s",
    "plastic_ggx": "diffuse S, alpha s, eta s",
    "ward": WARD,
    "ward_duer": WARD,
    "ward_bounded": WARD,
    "ashikhmin_shirley": "diffuse S, specular S, exponent_u s, exponent_v s",
    "lafortune": "diffuse SL, specular SL, c_x s, c_y s, c_z s, exponent s",
    "banks": TWO,
    "he": "sigma0 s, tau s, eta S, k S, diffuse SL",
    "ggx_anisotropic": "diffuse SL, f0 SL, alpha_x s, alpha_y s",
    "ggx_multiscatter": "diffuse SL, f0 S, alpha s",
    "student_t": f"{GGX}, gamma s",
    "principled": "base S, metallic s, roughness s, specular s, sheen s, clearcoat s, "
    "clearcoat_gloss s",
    "sum": "first.albedo SL, second.f0 SL, second.alpha s",
}


def test_catalogue_is_complete():
    assert set(CATALOGUE) <= set(MODELS)


@pytest.mark.parametrize("name", CATALOGUE)
def test_parameters_are_those_of_the_catalogue(name):
    found = [
        f"{field} {'S' if known.spectral else 's'}{'L' * known.linear}"
        for field, known in parameters(MODELS[name]()).items()
    ]
    assert ", ".join(found) == CATALOGUE[name]


@pytest.mark.parametrize("name", CATALOGUE)
def test_defaults_and_typical_ranges_are_legal(name):
    brdf = MODELS[name]()
    for field, known in parameters(brdf).items():
        low, high = known.typical
        assert known.lower <= low < high <= known.upper, field
