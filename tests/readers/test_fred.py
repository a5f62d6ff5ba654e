import numpy as np
import pytest

from brdffit.readers import fred
from tests.data import shared_data
from tests.readers import specimens


def direction(theta, phi):
    theta, phi = np.radians([theta, phi])
    return [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)]


def test_rows_come_back_exactly_and_azimuth_0_is_forward(tmp_path):
    measured = fred.load(specimens.fred(tmp_path))
    assert len(measured) == 18
    assert measured.mask.all()
    row = np.flatnonzero(measured.f_r[:, 0] == 1.506009)[0]  # light 50, view 60, 90
    np.testing.assert_allclose(measured.wi[row], direction(50, 0), atol=1e-15)
    np.testing.assert_allclose(measured.wo[row], direction(60, 90 + 180), atol=1e-15)


def test_scale_and_radians_are_obeyed(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text(
        "type bsdf_data\nformat angles=rad bsdf=value scale=0.5\n1 0\n0.5 0.25 3\n"
    )
    measured = fred.load(path)
    assert measured.f_r[0, 0] == 1.5
    np.testing.assert_allclose(measured.wi[0], [np.sin(1), 0, np.cos(1)], atol=1e-15)
    np.testing.assert_allclose(measured.wo[0, 2], np.cos(0.5))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("type bsdf_data\n", "cut off"),
        ("type bsdf_data\nformat bsdf=value\n10 0\n0 0 1\n", "Line 2 .* angles=deg"),
        ("type bsdf_data\nformat angles=deg bsdf=log\n10 0\n0 0 1\n", "bsdf=value"),
        ("type bsdf_data\nformat angles=deg bsdf=value\n0 0 1\n", "Line 3"),
        ("type bsdf_data\nformat angles=deg bsdf=value\n10 0\n20 0\n", "Line 4"),
        ("type bsdf_data\nformat angles=deg bsdf=value\n10 0\n", "cut off"),
        ("type bsdf_data\nformat angles=deg bsdf=value\n10 0\n0 0 x\n", "`x` is not a"),
        ("type bsdf_data\nformat angles=deg bsdf=value\n10 0\n0 0 1_0\n", "`1_0` is"),
        ("type bsdf_data\nformat angles=deg bsdf=value\n10 0\n0 0 nan\n", "no value"),
    ],
)
def test_a_wrong_file_is_one_sentence(tmp_path, text, sentence):
    path = tmp_path / "a.txt"
    path.write_text(text)
    with pytest.raises(ValueError, match=sentence):
        fred.load(path)


def test_a_cut_in_a_block_or_in_a_number_is_found(tmp_path):
    path = specimens.fred(tmp_path)
    lines = path.read_text().splitlines()
    path.write_text("\n".join(lines[:-4]) + "\n")
    with pytest.raises(ValueError, match="its last block ends at polar angle 30"):
        fred.load(path)
    path.write_text("\n".join(lines)[:-2])
    with pytest.raises(ValueError, match="cut off within its last number, `60"):
        fred.load(path)


def test_nan_and_negative_values_are_kept_and_masked(tmp_path):
    path = specimens.fred(tmp_path)
    path.write_text(
        path.read_text().replace("1.100000", "nan").replace("1.106018", "-1.000000")
    )
    measured = fred.load(path)
    assert (~measured.mask).sum() == 2
    assert np.isnan(measured.f_r).sum() == 1
    assert (measured.f_r < 0).sum() == 1


@pytest.mark.parametrize("name", ["AnoBlackEC1onAlum", "AnoBlackNiTEonINVAR"])
def test_measured_coatings_have_all_rows_and_peak_forward(name):
    path = shared_data("ualoft", f"{name}.txt")
    measured = fred.load(path)
    rows = [line.split() for line in path.read_text().splitlines()[2:]]
    plain = [float(row[2]) for row in rows if len(row) == 3]
    assert len(measured) == 1144
    np.testing.assert_array_equal(measured.f_r[:, 0], plain)
    peak = measured.f_r[:, 0].argmax()
    assert measured.wi[peak] @ measured.wo[peak] < 0  # light and viewer on two sides
    # At 10 degrees, far from grazing, the peak is the mirror direction itself.
    near = np.flatnonzero(measured.wi[:, 2] > np.cos(np.radians(11)))
    peak = near[measured.f_r[near, 0].argmax()]
    mirror = measured.wi[peak] * [-1, -1, 1]
    assert mirror @ measured.wo[peak] > np.cos(np.radians(5.1))


def test_values_that_overflow_are_masked(tmp_path):
    path = specimens.fred(tmp_path)
    path.write_text(path.read_text().replace("scale=1", "scale=1e308"))
    measured = fred.load(path)
    assert np.isinf(measured.f_r).any() == (~measured.mask).any()
    path.write_text(path.read_text().replace("1.100000", "9.100000"))
    assert np.isinf(fred.load(path).f_r).sum() == 1
