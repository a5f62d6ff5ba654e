import numpy as np
import pytest

from brdffit.scene import Orthographic, Perspective


def test_rays_pass_through_pixel_centres_row_by_row_from_the_top():
    origin, direction = Orthographic(2).rays()
    expected = [[-0.5, 0.5], [0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]]
    np.testing.assert_array_equal(origin[:, :2], expected)
    np.testing.assert_array_equal(direction, np.tile([0, 0, -1], (4, 1)))


@pytest.mark.parametrize("resolution", [0, -3, 1.5, "8", True])
def test_resolution_is_a_positive_whole_number(resolution):
    with pytest.raises(ValueError, match="`resolution` must be a whole number"):
        Orthographic(resolution)


def test_an_orthographic_camera_may_look_from_anywhere():
    camera = Orthographic([2, 4], towards=[0, 1, 0], up=[0, 0, -1], height=4)
    origin, direction = camera.rays()
    assert camera.shape == (2, 4)
    np.testing.assert_allclose(direction, np.tile([0, -1, 0], (8, 1)))
    np.testing.assert_allclose(origin[0, [0, 2]], [-3, -1], atol=1e-12)
    np.testing.assert_allclose(origin[-1, [0, 2]], [3, 1], atol=1e-12)


def test_rays_of_a_perspective_camera_spread_by_its_field_of_view():
    camera = Perspective(200, position=[0, 0, 5], field_of_view=90)
    origin, direction = camera.rays()
    np.testing.assert_array_equal(origin, np.tile([0, 0, 5], (200**2, 1)))
    np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1, rtol=1e-15)
    slope = direction[:, :2] / -direction[:, 2:]
    np.testing.assert_allclose(slope[0], [-0.995, 0.995], rtol=1e-12)
    np.testing.assert_allclose(slope[199], [0.995, 0.995], rtol=1e-12)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"position": [0, 0, 0]}, "`target` must be another point than `position`"),
        ({"position": [0, 3, 0]}, "`up` must not be the direction of view"),
        ({"position": [0, 0, 3], "field_of_view": 180}, "between 0 and 180 degrees"),
        ({"position": [0, 0]}, "`position` must be three numbers"),
        ({"position": [0, 0, 3], "resolution": [2, 0]}, "`resolution` must be a whole"),
    ],
)
def test_a_camera_that_looks_nowhere_is_refused(wrong, sentence):
    with pytest.raises(ValueError, match=sentence):
        Perspective(**({"resolution": 4} | wrong))


@pytest.mark.parametrize("some", [slice(5, 12, 3), np.array([14, 0, 7])])
@pytest.mark.parametrize(
    "camera", [Orthographic([3, 5]), Perspective([3, 5], position=[1, 2, 5])]
)
def test_some_rays_are_those_of_all(camera, some):
    for part, whole in zip(camera.rays(some), camera.rays(), strict=True):
        np.testing.assert_array_equal(part, whole[some])
