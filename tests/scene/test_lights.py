import numpy as np
import pytest

from brdffit.scene import Directional


def test_a_direction_gets_back_the_length_that_rounding_took():
    light = Directional([0.577, 0.577, 0.577])
    np.testing.assert_allclose(light.direction, np.full(3, 3**-0.5), rtol=1e-15)


def test_a_direction_of_unit_length_is_left_as_it_is():
    once = Directional([0.1, 0.2, 0.97468]).direction
    np.testing.assert_array_equal(Directional(once).direction, once)
    np.testing.assert_array_equal(
        Directional([-0.48, 0.6, 0.64]).direction, [-0.48, 0.6, 0.64]
    )


@pytest.mark.parametrize("length", [0.0, 0.998, 1.002])
def test_a_direction_of_another_length_is_refused(length):
    with pytest.raises(ValueError, match=rf"has length {length:g}\."):
        Directional([0, 0, length])


def test_irradiance_is_not_negative():
    with pytest.raises(ValueError, match="`irradiance` must be"):
        Directional([0, 0, 1], -1.0)
