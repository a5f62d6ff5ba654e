import numpy as np
import pytest

from brdffit.scene import Orthographic


def test_rays_pass_through_pixel_centres_row_by_row_from_the_top():
    origin, direction = Orthographic(2).rays()
    expected = [[-0.5, 0.5], [0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]]
    np.testing.assert_array_equal(origin[:, :2], expected)
    np.testing.assert_array_equal(direction, np.tile([0, 0, -1], (4, 1)))


@pytest.mark.parametrize("resolution", [0, -3, 1.5, "8", True])
def test_resolution_is_a_positive_whole_number(resolution):
    with pytest.raises(ValueError, match="`resolution` must be a whole number"):
        Orthographic(resolution)
