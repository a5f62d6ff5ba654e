import numpy as np
import pytest

from brdffit.readers import format_of, fred, zemax
from tests.data import shared_data
from tests.readers import specimens


def at(measured, value):
    return np.flatnonzero(np.isclose(measured.f_r[:, 0], value, rtol=1e-10, atol=0))[0]


def direction(theta, phi):
    theta, phi = np.radians([theta, phi])
    return [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)]


def test_radial_0_is_the_mirror_and_azimuth_0_points_back(tmp_path):
    measured = zemax.load(specimens.zemax(tmp_path))
    assert len(measured) == 24
    mirror = at(measured, 1 + 40e-5)
    np.testing.assert_allclose(measured.wi[mirror], direction(40, 0), atol=1e-15)
    np.testing.assert_allclose(measured.wo[mirror], direction(40, 180), atol=1e-15)
    back = at(measured, 1 + 40e-5 + 20e-9)
    np.testing.assert_allclose(measured.wo[back], direction(20, 180), atol=1e-15)
    forward = at(measured, 1 + 40e-5 + 180e-8 + 20e-9)
    np.testing.assert_allclose(measured.wo[forward], direction(60, 180), atol=1e-15)
    aside = at(measured, 1 + 40e-5 + 90e-8 + 20e-9)
    specular = np.array(direction(40, 180))
    np.testing.assert_allclose(specular @ measured.wo[aside], np.cos(np.radians(20)))
    assert measured.wo[aside, 1] == pytest.approx(np.sin(np.radians(20)))


def test_cells_of_zero_hold_no_data(tmp_path):
    measured = zemax.load(specimens.zemax(tmp_path))
    assert (~measured.mask).sum() == 2
    assert (measured.f_r[~measured.mask] == 0).all()


def test_tristimulus_and_turned_samples_are_read(tmp_path):
    measured = zemax.load(specimens.zemax(tmp_path, "XYZ", rotations=(0, 30)))
    assert measured.channels == ("X", "Y", "Z")
    assert measured.f_r.shape == (48, 3)
    turned = at(measured, 1 + 30e-3 + 40e-5)
    np.testing.assert_allclose(measured.wi[turned], direction(40, -30), atol=1e-15)
    np.testing.assert_allclose(measured.wo[turned], direction(40, 150), atol=1e-15)
    np.testing.assert_allclose(
        measured.f_r[turned], measured.f_r[turned, 0] + [0, 1, 2]
    )


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("BRDF", "BTDF", "ScatterType must be BRDF"),
        ("Monochrome", "Spectral", "SpectralContent must be Monochrome or XYZ"),
        ("ScatterRadial\t3", "ScatterRadial\t4", "Line 15 .* `Monochrome` is not"),
        ("ScatterRadial\t3", "ScatterRadial\t-1", "must be 1 or more"),
        ("ScatterRadial\t3", "ScatterRadial\t1e30", "is not a number"),
        ("ScatterRadial\t3", "ScatterRadial\tnan", "must be 1 or more"),
        ("ScatterRadial", "Radial", "`Radial` is no label"),
        ("DataEnd", "", "cut off"),
        ("TIS", "TOS", "`TIS` should stand here"),
    ],
)
def test_a_wrong_header_is_one_sentence(tmp_path, old, new, sentence):
    path = specimens.zemax(tmp_path)
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(ValueError, match=sentence):
        zemax.load(path)


@pytest.mark.parametrize("name", ["AnoBlackEC1onAlum", "AnoBlackNiTEonINVAR"])
def test_measured_coatings_agree_with_their_fred_files(name):
    zemax_file = zemax.load(shared_data("ualoft", f"{name}.bsdf"))
    fred_file = fred.load(shared_data("ualoft", f"{name}.txt"))
    assert len(zemax_file) == 912
    assert zemax_file.mask.sum() == 719
    ratios = []
    for theta in (10, 30, 50):
        found = []
        for measured in (fred_file, zemax_file):
            lit = np.isclose(measured.wi[:, 2], np.cos(np.radians(theta)))
            mirror = np.isclose(measured.wo, measured.wi * [-1, -1, 1]).all(axis=1)
            found.append(measured.f_r[np.flatnonzero(lit & mirror)[0], 0])
        ratios.append(found[1] / found[0])
    assert np.abs(np.log(ratios)).max() < 0.06
    # Elsewhere too, where both hold nearly the same pair of directions.
    both = np.concatenate([fred_file.wi, fred_file.wo * [1, -1, 1]], axis=1)
    errors = []
    for row in np.flatnonzero(zemax_file.mask[:, 0]):
        pair = np.concatenate([zemax_file.wi[row], zemax_file.wo[row]])
        distance = np.abs(both - pair).max(axis=1)
        if distance.min() < 0.02:
            other = fred_file.f_r[distance.argmin(), 0]
            errors.append(np.log(zemax_file.f_r[row, 0] / other))
    assert len(errors) > 50
    assert np.median(np.abs(errors)) < 0.05


def test_specular_values_are_those_of_the_file():
    measured = zemax.load(shared_data("ualoft", "AnoBlackEC1onAlum.bsdf"))
    mirror = np.isclose(measured.wo, measured.wi * [-1, -1, 1]).all(axis=1)
    lit = np.isclose(measured.wi[:, 2], np.cos(np.radians(50)))
    assert set(measured.f_r[mirror & lit, 0]) == {0.09325}


def test_the_order_of_the_header_does_not_matter(tmp_path):
    path = specimens.zemax(tmp_path)
    before = zemax.load(path)
    text = path.read_text()
    moved = text.replace("Source\tMeasured\n", "").replace(
        "ScatterType", "Source\tMeasured\nScatterType"
    )
    path.write_text(moved)
    assert format_of(path) == "zemax"
    np.testing.assert_array_equal(zemax.load(path).f_r, before.f_r)
