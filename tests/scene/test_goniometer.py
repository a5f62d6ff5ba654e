import numpy as np
import pytest

from brdffit.scene import Goniometer


def test_directions_are_all_combinations_of_the_angles():
    goniometer = Goniometer([0, 30], [0, 60], [0, 90, 180])
    wi, wo = goniometer.directions()
    assert wi.shape == wo.shape == (12, 3)
    assert wi.dtype == wo.dtype == np.float32
    np.testing.assert_allclose(wi[-1], [0.5, 0, 0.75**0.5], rtol=1e-7)
    np.testing.assert_allclose(wo[-3:, 2], 0.5, rtol=1e-7)


def test_azimuth_180_is_forward_and_0_is_back():
    wi, wo = Goniometer([40], [40], [0, 180]).directions()
    np.testing.assert_array_equal(wo[0], wi[0])
    np.testing.assert_allclose(wo[1], wi[1] * [-1, 1, 1], atol=1e-7)


@pytest.mark.parametrize(
    ("angles", "sentence"),
    [
        (([90], [0], [0]), "`theta_i` must lie from 0 to below 90 degrees"),
        (([0], [-1], [0]), "`theta_o` must lie from 0 to below 90 degrees"),
        (([0], [], [0]), "`theta_o` must be a list of angles"),
        (([0], [0], [np.nan]), "`phi` must consist of finite numbers"),
    ],
)
def test_wrong_angles_are_named(angles, sentence):
    with pytest.raises(ValueError, match=sentence):
        Goniometer(*angles)
