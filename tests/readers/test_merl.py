import time

import numpy as np
import pytest

from brdffit import half_difference
from brdffit.readers import merl
from brdffit.samples import Measurement
from brdffit.writers import merl as writer
from tests.readers import specimens


@pytest.fixture(scope="module")
def cells():
    return half_difference.cells()


def cell(theta_h, theta_d, phi_d):
    return (theta_h * 90 + theta_d) * 180 + phi_d


def test_cells_have_the_half_and_difference_angles_of_their_centres(cells):
    wi, wo, _ = cells
    for index in [(0, 0, 0), (3, 50, 20), (40, 10, 170), (89, 89, 90)]:
        row = cell(*index)
        half = wi[row] + wo[row]
        half /= np.linalg.norm(half)
        centre = (np.array(index) + 0.5) / [90, 90, 180]
        theta_h = centre[0] ** 2 * np.pi / 2
        np.testing.assert_allclose(
            half, [np.sin(theta_h), 0, np.cos(theta_h)], atol=1e-13
        )
        theta_d = centre[1] * np.pi / 2
        assert wi[row] @ half == pytest.approx(np.cos(theta_d))
        # Azimuth of the light about the half vector, from the tangent tilted with it.
        x = wi[row] @ [np.cos(theta_h), 0, -np.sin(theta_h)]
        phi_d = np.arctan2(wi[row][1], x)
        assert phi_d == pytest.approx(centre[2] * np.pi)


def test_cells_above_the_horizon_are_all_pairs_of_directions(cells):
    wi, wo, size = cells
    above = (wi[:, 2] > 0) & (wo[:, 2] > 0)
    assert size[above].sum() == pytest.approx((2 * np.pi) ** 2, rel=1e-3)
    # The mean of cos_i cos_o over pairs is 1/4.
    mean = np.average(wi[above, 2] * wo[above, 2], weights=size[above])
    assert mean == pytest.approx(0.25, rel=1e-3)


def test_scales_masks_and_order_are_those_of_the_format(tmp_path, cells):
    path = specimens.merl(tmp_path)
    stored = np.memmap(path, "<f8", "r+", offset=12, shape=(3, half_difference.COUNT))
    row = cell(2, 30, 60)
    stored[:, row] = [1.0, 2.0, 3.0]
    stored.flush()
    start = time.process_time()
    measured = merl.load(path)
    assert time.process_time() - start < 1
    expected = [1 / 1500, 2 * 1.15 / 1500, 3 * 1.66 / 1500]
    np.testing.assert_allclose(measured.f_r[row], expected, rtol=1e-15)
    above = (cells[0][:, 2] > 1e-6) & (cells[1][:, 2] > 1e-6)
    assert above[7]
    assert not measured.mask[7].any()
    assert (measured.f_r[7] < 0).all()
    above[7] = False
    np.testing.assert_array_equal(measured.mask[:, 0], above)
    np.testing.assert_array_equal(measured.solid_angle, cells[2])


def test_what_is_written_is_read_back(tmp_path, cells):
    wi, wo, _ = cells
    f_r = np.random.default_rng(0).lognormal(size=(len(wi), 3))
    mask = f_r > 0.2
    made = Measurement(wi=wi, wo=wo, f_r=f_r, mask=mask, name="made")
    writer.save(made, tmp_path / "a.binary")
    back = merl.load(tmp_path / "a.binary")
    above = (wi[:, 2] > 1e-6) & (wo[:, 2] > 1e-6)
    np.testing.assert_array_equal(back.mask, mask & above[:, None])
    np.testing.assert_allclose(back.f_r[back.mask], f_r[back.mask], rtol=3e-16)
    # What came from such a file goes back to the last bit.
    writer.save(back, tmp_path / "b.binary")
    again = merl.load(tmp_path / "b.binary")
    np.testing.assert_array_equal(again.f_r[again.mask], back.f_r[back.mask])


def test_other_directions_cannot_be_written(tmp_path, cells):
    wi, wo, _ = cells
    swapped = Measurement(wi=wo, wo=wi, f_r=np.ones((len(wi), 3)))
    for wrong in (swapped, specimens.measurement()):
        with pytest.raises(ValueError, match="cannot be written as MERL"):
            writer.save(wrong, tmp_path / "a.binary")
    assert not list(tmp_path.iterdir())


def test_a_file_of_another_size_is_refused(tmp_path):
    path = specimens.merl(tmp_path)
    whole = path.read_bytes()
    path.write_bytes(whole[:-1])
    with pytest.raises(ValueError, match="has 34992011; it is cut off"):
        merl.load(path)
    path.write_bytes(whole + b"\0")
    with pytest.raises(ValueError, match="of another kind"):
        merl.load(path)
