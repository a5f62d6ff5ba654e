import numpy as np
import pytest

from brdffit.exports.deviation import FLOOR, LOWEST, deviation, pairs


def test_pairs_lie_above_the_horizon_and_half_of_them_in_the_highlight():
    wi, wo = pairs()
    half = wi + wo
    slope = np.hypot(half[:, 0], half[:, 1]) / half[:, 2]
    assert min(wi[:, 2].min(), wo[:, 2].min()) >= LOWEST
    assert np.allclose(np.linalg.norm(wo, axis=1), 1)
    assert 0.1 < np.mean(slope < 1e-2) < 0.25  # one decade of three, of a half
    assert 0.4 < np.mean(slope > 0.3) < 0.7


def test_errors_are_relative_down_to_a_floor():
    def constant(value):
        return lambda wi, _: np.full((len(wi), 3), value)

    found = deviation(constant(0.5), constant(0.6))
    assert (found.largest, found.mean) == pytest.approx((0.2, 0.2))
    dark = deviation(constant(0.0), constant(1e-4))
    assert dark.largest == pytest.approx(1e-4 / FLOOR)


def test_the_largest_error_is_found_with_its_angles():
    def step(wi, wo):
        return np.where(wi[:, 2:] > 0.99, 2.0, 1.0) + 0 * wo

    found = deviation(lambda wi, _: np.ones((len(wi), 3)), step)
    assert found.largest == 1
    assert found.theta_i < 8.2


def test_what_is_not_finite_is_refused():
    with pytest.raises(ValueError, match="not finite"):
        deviation(lambda _, wo: 1 + 0 * wo, lambda _, wo: np.nan * wo)
