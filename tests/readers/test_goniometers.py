"""NIST PTFE, CUReT, ASTM, LightTools and UTIA: each against numbers in its own file."""

import numpy as np
import pytest

from brdffit.readers import astm, curet, lighttools, nist_ptfe, utia
from tests.data import shared_data
from tests.readers import specimens


def direction(theta, phi):
    theta, phi = np.radians([theta, phi])
    return [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)]


def row_of(measured, value):
    return np.flatnonzero(np.isclose(measured.f_r[:, 0], value, rtol=1e-12, atol=0))[0]


def test_nist_azimuth_0_is_forward_because_the_polar_angle_is_signed(tmp_path):
    measured = nist_ptfe.load(specimens.nist_ptfe(tmp_path))
    assert len(measured) == 9
    assert measured.channels == ("532 nm",)
    mirror = row_of(measured, 0.345)
    np.testing.assert_allclose(measured.wi[mirror], direction(45, 180), atol=1e-15)
    np.testing.assert_allclose(measured.wo[mirror], direction(45, 0), atol=1e-15)


def test_nist_several_wavelengths_are_refused(tmp_path):
    path = specimens.nist_ptfe(tmp_path)
    path.write_text(path.read_text().replace("0.532", "0.633", 1))
    with pytest.raises(ValueError, match="several wavelengths"):
        nist_ptfe.load(path)


def test_nist_ptfe_is_brighter_forward_and_nearly_lambertian():
    measured = nist_ptfe.load(shared_data("nist_ptfe", "ptfe_regular_532nm.csv"))
    assert measured.mask.shape == (1824, 1)
    assert measured.mask.all()
    f_r = measured.f_r[:, 0]
    cos_i = measured.wi[:, 2]
    constant = np.sum(f_r * cos_i**2) / np.sum(cos_i**2)
    spread = np.sqrt(np.average((f_r / constant - 1) ** 2, weights=cos_i))
    assert constant * np.pi == pytest.approx(0.987, abs=2e-3)
    assert spread == pytest.approx(0.0675, abs=1e-3)
    low = (measured.wi[:, 2] < 0.3) & (measured.wo[:, 2] < 0.3)
    azimuth = measured.wi[:, :2] * measured.wo[:, :2]
    forward = azimuth.sum(axis=1) < -0.8
    backward = azimuth.sum(axis=1) > 0.8
    assert f_r[low & forward].mean() > 1.5 * f_r[low & backward].mean()


def test_curet_reads_one_material_or_all(tmp_path):
    folder = specimens.curet(tmp_path)
    every = curet.load(folder)
    second = curet.load(folder / "abrdf.dat", sample=2)
    assert every.f_r.shape == (205, 3)
    assert (~every.mask).sum() == 3
    np.testing.assert_array_equal(second.f_r[:, 0], every.f_r[:, 1])
    assert second.channels == ("2",)
    first = (folder / "table.txt").read_text().split()[1:5]
    theta_o, phi_o, theta_i, phi_i = np.degrees([float(word) for word in first])
    np.testing.assert_allclose(every.wi[0], direction(theta_i, phi_i))
    np.testing.assert_allclose(every.wo[0], direction(theta_o, phi_o))
    with pytest.raises(ValueError, match="no sample 62; it has 1 to 3"):
        curet.load(folder, sample=62)


def test_curet_glossy_materials_peak_at_the_mirror_direction():
    folder = shared_data("curet", "abrdf.dat").parent
    every = curet.load(folder)
    assert every.f_r.shape == (205, 61)
    assert (every.f_r <= 0).sum() == 43
    half = every.wi + every.wo
    tilt = np.degrees(np.arccos(half[:, 2] / np.linalg.norm(half, axis=1)))
    for sample in (9, 15, 34, 41):
        assert tilt[every.f_r[:, sample - 1].argmax()] < 1


@pytest.mark.parametrize("unit", [1.0, 180 / np.pi])
def test_astm_reads_radians_and_degrees(tmp_path, unit):
    measured = astm.load(specimens.astm(tmp_path, unit))
    assert measured.channels == ("R", "G", "B")
    np.testing.assert_allclose(measured.f_r[1], [0.5, 1, 1.5])
    mirror = measured.wi[1] * [-1, -1, 1]
    np.testing.assert_allclose(measured.wo[1], mirror, atol=1e-6)


def test_astm_names_wavelengths_and_counts_points(tmp_path):
    path = specimens.astm(tmp_path, names="400nm,500nm,600nm")
    assert astm.load(path).channels == ("400nm", "500nm", "600nm")
    text = path.read_text()
    path.write_text(text.replace("NUM_POINTS 4", "NUM_POINTS 400000000000"))
    with pytest.raises(ValueError, match="promises 4e.11 points, but has 4"):
        astm.load(path)
    path.write_text(text.replace("theta_s", "theta_x"))
    with pytest.raises(ValueError, match="must name theta_i, phi_i, theta_s, phi_s"):
        astm.load(path)
    path.write_text(text.replace(",1.500000\n", "\n"))
    with pytest.raises(ValueError, match="Line 5 .* 7 numbers, but has 6"):
        astm.load(path)


def test_lighttools_light_comes_from_azimuth_90(tmp_path):
    measured = lighttools.load(specimens.lighttools(tmp_path))
    assert measured.channels == ("450 nm", "550 nm")
    assert measured.f_r.shape == (24, 2)
    row = row_of(measured, 1 + 30e-3 + 270e-6 + 30e-8)
    np.testing.assert_allclose(measured.f_r[row, 1], measured.f_r[row, 0] + 1)
    np.testing.assert_allclose(measured.wi[row], direction(30, 90), atol=1e-15)
    np.testing.assert_allclose(measured.wo[row], direction(30, 270), atol=1e-15)


def test_lighttools_tristimulus_values_become_channels(tmp_path):
    measured = lighttools.load(specimens.lighttools(tmp_path, "XYZ"))
    assert measured.channels == ("X", "Y", "Z")
    np.testing.assert_allclose(measured.f_r[0], [1, 2, 3])


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("BRDF", "BTDF", "no reflection at the front side"),
        ("Front", "Back", "no reflection at the front side"),
        ("AOI 30", "AOI 0", "one block for each incidence and channel"),
        ("Wavelength 450", "Wavelength 500", "must have one block"),
        ("AOI 30\nPOI 0", "POI 0", "must give its AOI"),
        ("ScatterRadial 3", "ScatterRadial 9", "is not a number"),
        ("DataEnd", "", "cut off"),
        ("TIS", "TOS", "`TOS` is no label of a LightTools block"),
        ("DataBegin", "Data", "`Data` is no label of a LightTools header"),
    ],
)
def test_a_wrong_lighttools_file_is_one_sentence(tmp_path, old, new, sentence):
    path = specimens.lighttools(tmp_path)
    count = 1 if old.startswith("Wavelength") else -1
    path.write_text(path.read_text().replace(old, new, count))
    with pytest.raises(ValueError, match=sentence):
        lighttools.load(path)


def test_utia_rows_are_lights_and_columns_viewers(tmp_path):
    measured = utia.load(specimens.utia(tmp_path))
    assert measured.f_r.shape == (288 * 288, 3)
    row = (2 * 48 + 12) * 288 + 3 * 48 + 36  # light 30, 90 degrees; viewer 45, 270
    np.testing.assert_allclose(measured.f_r[row], np.array([1, 2, 3]) * 0.208180)
    np.testing.assert_allclose(measured.wi[row], direction(30, 90), atol=1e-15)
    np.testing.assert_allclose(measured.wo[row], direction(45, 270), atol=1e-15)


def test_utia_of_another_size_is_refused(tmp_path):
    path = specimens.utia(tmp_path)
    path.write_bytes(path.read_bytes()[:-8])
    with pytest.raises(ValueError, match="must have 1990656 bytes.*cut off"):
        utia.load(path)
