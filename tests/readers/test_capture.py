import dataclasses

import numpy as np
import OpenImageIO
import pytest

from brdffit import MODELS, images
from brdffit.readers.capture import open_capture
from brdffit.scene import Ambient, load_scene, save_scene
from tests import wall
from tests.readers import specimens


@pytest.fixture
def folder(tmp_path):
    wall.photograph(tmp_path / "wall", (4, 6), lights=3)
    return tmp_path / "wall"


def test_a_folder_with_a_scene_has_a_light_for_each_photograph(folder):
    capture = open_capture(folder)
    assert capture.names == ["00.exr", "01.exr", "02.exr"]
    assert capture.channels == ("R", "G", "B")
    assert len(capture.scene.lights) == 3
    assert capture.mask.shape == (4, 6)
    assert capture.mask.all()
    assert capture.normals is None
    assert capture.radiance == 1


def test_mask_and_normal_map_are_found_beside_the_scene(folder):
    tilted = np.broadcast_to(np.float32([0.6, 0, 0.8]), (4, 6, 3))
    mask = np.zeros((4, 6, 1), np.float32)
    mask[1:3] = 1
    images.write(folder / "mask.png", mask)
    images.write(folder / "normals.exr", tilted, ("X", "Y", "Z"))
    capture = open_capture(folder)
    np.testing.assert_array_equal(capture.mask, mask[..., 0] > 0)
    np.testing.assert_array_equal(capture.normals(1, 3), tilted[1:3])
    (folder / "normals.exr").unlink()
    images.write(folder / "normals.png", (tilted + 1) / 2)
    np.testing.assert_allclose(open_capture(folder).normals(0, 4), tilted, atol=2e-5)


def test_a_folder_of_ball_photographs_needs_no_scene(tmp_path):
    capture = open_capture(specimens.sphere_photos(tmp_path))
    assert len(capture.photographs) == len(capture.scene.lights) == 3
    normal = capture.normals(5, 7)[:, 6]
    np.testing.assert_allclose(normal[:, 2], 1, atol=0.02)
    assert capture.radiance == pytest.approx(1 / np.pi)


def change(folder, **new):
    scene = load_scene(folder / "scene.toml")
    save_scene(dataclasses.replace(scene, **new), folder / "scene.toml")


def another_size(folder):
    images.write(folder / "01.exr", np.ones((4, 5, 3), np.float32))


def another_number_of_channels(folder):
    images.write(folder / "01.exr", np.ones((4, 6, 1), np.float32))


def too_few_lights(folder):
    change(folder, lights=load_scene(folder / "scene.toml").lights[:2])


def ambient_light(folder):
    lights = load_scene(folder / "scene.toml").lights
    change(folder, lights=(*lights[:2], Ambient(0.1)))


def another_camera(folder):
    change(folder, camera=wall.scene((8, 8)).camera)


def a_material_of_its_own(folder):
    shape = load_scene(folder / "scene.toml").shapes[0]
    change(folder, shapes=[dataclasses.replace(shape, material=MODELS["lambert"]())])


def no_lights_at_all(folder):
    (folder / "scene.toml").unlink()


def no_photographs(folder):
    for path in folder.glob("*.exr"):
        path.unlink()


def eight_bits(folder):
    buffer = OpenImageIO.ImageBuf(np.ones((4, 6, 3), np.uint8))
    buffer.write(str(folder / "03.png"))


def a_mask_of_another_size(folder):
    images.write(folder / "mask.png", np.ones((4, 4, 1), np.float32))


def normals_with_one_channel(folder):
    images.write(folder / "normals.exr", np.ones((4, 6, 1), np.float32))


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (
            another_size,
            "one size, but `.*00.exr` has 4 x 6 pixels and `.*01.exr` 4 x 5",
        ),
        (another_number_of_channels, "same channels, but .* R, G, B and .* Y"),
        (too_few_lights, "3 photographs and `scene.toml` 2 lights"),
        (ambient_light, "`lights.2.` in .* must be directional or point"),
        (another_camera, "`.*00.exr` has 4 x 6 pixels, but the camera .* 8 x 8"),
        (a_material_of_its_own, "No shape in `.*scene.toml` is there to be fitted"),
        (no_lights_at_all, "says nothing about its lights: it must hold scene.toml or"),
        (no_photographs, "holds no photographs"),
        (eight_bits, "`.*03.png` has 8 bits a channel"),
        (
            a_mask_of_another_size,
            "mask.png` has 4 x 4 pixels, but the photographs .* 4 x 6",
        ),
        (normals_with_one_channel, "three channels x, y and z, but have 1"),
    ],
)
def test_a_wrong_folder_is_one_sentence(folder, spoil, sentence):
    spoil(folder)
    with pytest.raises((ValueError, OSError), match=sentence):
        open_capture(folder)
