import numpy as np
import pytest

from brdffit.batch.relighting import held_out, relative_errors
from brdffit.batch.stack import TexelStack
from brdffit.fit.texels import Texels


def test_the_photograph_that_is_held_out_is_in_no_fit():
    rng = np.random.default_rng(0)
    wi, wo, value = rng.random((3, 5, 3, 4), np.float32)
    mask = rng.random((5, 3, 4)) > 0.5
    texels = Texels(wi, wo, np.ones((5, 1, 1), np.float32), value, mask)
    rest, other = held_out(TexelStack(texels), 5, 2)
    np.testing.assert_array_equal(rest.read(1, 3).value, value[[0, 1, 3, 4], :, 1:3])
    np.testing.assert_array_equal(other.read(1, 3).value, value[[2], :, 1:3])
    np.testing.assert_array_equal(rest.read(0, 4).mask, mask[[0, 1, 3, 4]])
    assert rest.texels == other.texels == 4
    assert rest.channels == other.channels == 3


def test_errors_are_relative_to_the_photograph_where_there_is_one():
    photograph = np.full((2, 2, 3), 2.0)
    predicted = photograph + np.array([0.2, 0.0, -0.4])
    photograph[0, 0], predicted[1, 1] = np.nan, 2.0
    whole, *each = relative_errors(photograph, predicted)
    assert each == pytest.approx(
        [0.1 * np.sqrt(2 / 3), 0, 0.2 * np.sqrt(2 / 3)], abs=1e-12
    )
    assert whole == pytest.approx(np.sqrt(0.05 * 2 / 9))
