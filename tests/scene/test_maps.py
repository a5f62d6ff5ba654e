import numpy as np
import pytest

from brdffit import images
from brdffit.scene import Environment, HeightMap, Map, OpacityMap

RAMP = np.arange(12.0).reshape(3, 4)


def test_values_are_those_of_pixels_at_their_centres():
    row, column = np.divmod(np.arange(12), 4)
    place = np.stack([(column + 0.5) / 4, (row + 0.5) / 3], axis=1)
    np.testing.assert_allclose(Map.of("map", RAMP)(place)[:, 0], RAMP.ravel())


def test_ends_of_a_row_meet_and_columns_end():
    found = Map.of("map", RAMP)(np.array([[0.0, 0.5], [1.0, 0.5], [0.125, 0.0]]))
    np.testing.assert_allclose(found[:, 0], [5.5, 5.5, 0.0])


def test_a_map_without_end_repeats_downwards():
    found = Map.of("map", RAMP)(np.array([[0.125, 1.0], [0.125, 2.5]]), None)
    np.testing.assert_allclose(found[:, 0], [4.0, 4.0])


def test_slopes_are_those_of_the_height():
    v, u = np.mgrid[0:128, 0:256]
    u, v = (u + 0.5) / 256, (v + 0.5) / 128
    height = HeightMap(np.sin(2 * np.pi * u) * np.cos(2 * np.pi * v), 0.1, [2, 1])
    place = np.random.default_rng(0).random((200, 2))
    found = height.slopes(place, endless=True)
    a, b = 4 * np.pi * place[:, 0], 2 * np.pi * place[:, 1]
    expected = [
        0.4 * np.pi * np.cos(a) * np.cos(b),
        -0.2 * np.pi * np.sin(a) * np.sin(b),
    ]
    np.testing.assert_allclose(found.T, expected, atol=2e-3)


def test_a_surface_is_solid_where_the_opacity_reaches_its_threshold():
    opacity = OpacityMap([[0.0, 1.0]], threshold=0.75, repeat=[2, 1])
    place = np.array([[0.125, 0.5], [0.375, 0.5], [0.3, 0.5], [0.625, 0.5]])
    np.testing.assert_array_equal(
        opacity.solid(place, True), [False, True, False, False]
    )


def test_a_probe_shows_what_its_convention_says():
    pixels = np.zeros((32, 64, 3))
    pixels[:, 32], pixels[:, 48], pixels[0] = [1, 0, 0], [0, 1, 0], [0, 0, 1]
    probe = Environment(pixels, scale=2.0)
    around = np.radians(360 / 64 / 2)  # to the centre of a pixel
    directions = [
        [-np.sin(around), 0, np.cos(around)],
        [-np.cos(around), 0, -np.sin(around)],
        [0.0, 1.0, 0.0],
    ]
    np.testing.assert_allclose(
        probe.radiance(np.array(directions)), 2 * np.eye(3), atol=1e-12
    )


def test_a_map_may_come_from_a_file(tmp_path):
    images.write(tmp_path / "a.exr", np.ones((4, 8, 3), np.float32))
    found = Map.of("map", tmp_path / "a.exr")
    assert found.pixels.shape == (4, 8, 3)
    assert found.file == str(tmp_path / "a.exr")


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Environment("none.exr"), "`map`: Image `none.exr` does not exist"),
        (lambda: Environment(-RAMP), "`map` must hold finite radiance, none negative"),
        (lambda: Environment(0 * RAMP), "`map` must hold finite radiance"),
        (lambda: Environment(3), "`map` must be an image file or an array"),
        (lambda: HeightMap(RAMP * np.nan), "`map` must hold finite heights"),
        (lambda: HeightMap(RAMP, scale=0), "`scale` must be one number above 0"),
        (lambda: HeightMap(RAMP, repeat=[1, 2, 3]), "`repeat` must be one or two"),
        (lambda: OpacityMap(RAMP), "`map` must hold opacities from 0 to 1"),
        (lambda: OpacityMap(RAMP / 12, threshold=2), "`threshold` must be a number"),
    ],
)
def test_what_is_wrong_with_a_map_is_said_with_its_key(make, sentence):
    with pytest.raises((ValueError, OSError), match=sentence):
        make()
