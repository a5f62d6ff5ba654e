import dataclasses
import warnings

import numpy as np
import pytest

import brdffit
from brdffit.spectrum import rgb_matrix, to_rgb, wavelengths

BANDS = np.arange(400.0, 701.0, 10.0)
NAMES = tuple(f"{band:g} nm" for band in BANDS)


def data(f_r, names=NAMES, **details):
    w = np.array([[0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.0, 0.0, 1.0]])
    f_r = np.broadcast_to(f_r, (3, len(names))).astype(float)
    return brdffit.Measurement(w, w, f_r, channels=names, name="paint", **details)


def test_names_of_channels_tell_wavelengths():
    assert wavelengths(("532 nm", "0.65 um")).tolist() == [532, 650]
    assert wavelengths(("650nm",)).tolist() == [650]
    assert wavelengths(("R", "G", "B")) is None
    assert wavelengths(("1", "2")) is None


@pytest.mark.parametrize("illuminant", ["D65", "A", "E"])
def test_what_reflects_evenly_is_white_under_any_light(illuminant):
    seen = to_rgb(data(0.25), illuminant)
    assert seen.channels == ("R", "G", "B")
    assert seen.name == f"paint under {illuminant}"
    assert np.allclose(seen.f_r, 0.25, atol=1e-12)
    assert seen.mask.all()


def test_colours_are_those_of_colour_science():
    """A bell in the green, against the integration of colour-science itself."""
    colour = pytest.importorskip("colour")
    bell = 0.1 + 0.5 * np.exp(-(((BANDS - 540) / 60) ** 2))
    distribution = colour.SpectralDistribution(dict(zip(BANDS, bell, strict=True)))
    with warnings.catch_warnings(action="ignore"):  # it tells of its alignments
        light = colour.SDS_ILLUMINANTS["D65"]
        xyz = colour.sd_to_XYZ(distribution, illuminant=light) / 100
    expected = colour.XYZ_to_RGB(xyz, "sRGB")
    assert np.allclose(to_rgb(data(bell)).f_r[0], expected, atol=2e-3)


def test_order_of_wavelengths_does_not_matter():
    bell = np.exp(-(((BANDS - 540) / 60) ** 2))
    back = to_rgb(data(bell[::-1], NAMES[::-1])).f_r
    assert np.allclose(back, to_rgb(data(bell)).f_r)


def test_what_is_missing_or_out_of_gamut_is_masked():
    line = np.where(BANDS == 500, 1.0, 0.0)  # purer than Rec. 709 can be
    pure = to_rgb(data(line))
    assert (pure.f_r[:, 0] < 0).all()
    assert pure.mask.tolist() == [[False, True, True]] * 3
    mask = np.ones((3, len(BANDS)), bool)
    mask[1, 4] = False
    assert to_rgb(data(0.5, mask=mask)).mask.all(axis=1).tolist() == [True, False, True]


def test_errors_go_along():
    sigma = np.full((3, len(BANDS)), 0.01)
    seen = to_rgb(data(0.5, sigma=sigma))
    expected = 0.01 * np.sqrt(np.sum(rgb_matrix(BANDS) ** 2, axis=0))
    assert np.allclose(seen.sigma, expected)


@pytest.mark.parametrize(
    ("names", "reason"),
    [
        (("R", "G", "B"), "must have wavelengths for channels"),
        (("532 nm",), "must increase from 430 nm or less"),
        (("400 nm", "500 nm", "700 nm"), "in steps of at most 60 nm"),
        (("450 nm", "500 nm", "550 nm", "600 nm"), "must increase from 430 nm"),
    ],
)
def test_too_little_to_see_colours_by_is_refused(names, reason):
    with pytest.raises(ValueError, match=reason):
        to_rgb(data(0.5, names))


def test_an_unknown_light_suggests_the_nearest():
    with pytest.raises(ValueError, match="Did you mean `D65`"):
        to_rgb(data(0.5), "D 65")


def test_pixels_under_white_light_keep_their_f_r():
    truth = brdffit.MODELS["lambert"](albedo=np.linspace(0.2, 0.8, len(BANDS)))
    image = brdffit.simulate_image(truth, brdffit.lit_sphere(16))
    image = dataclasses.replace(image, channels=NAMES)
    seen = to_rgb(image)
    expected = np.linspace(0.2, 0.8, len(BANDS)) @ rgb_matrix(BANDS) / np.pi
    assert np.allclose(seen.f_r[seen.mask.all(axis=1)], expected, rtol=1e-5)
    tinted = dataclasses.replace(image, weight=image.weight * np.linspace(1, 2, 31))
    with pytest.raises(ValueError, match="lights are coloured"):
        to_rgb(tinted)
