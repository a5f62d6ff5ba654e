import dataclasses

import numpy as np
import OpenImageIO
import pytest
import scipy.io

from brdffit import MODELS, images
from brdffit.readers import exr_stack, sphere_exr, sphere_photos
from brdffit.render import simulate_image
from brdffit.scene import lit_sphere, save_scene
from tests.data import shared_data
from tests.readers import specimens


def test_an_image_read_back_is_the_simulation(tmp_path):
    scene = lit_sphere(12, directions=[(0, 0, 1), (0.6, 0, 0.8)], exposure=0.5)
    truth = simulate_image(MODELS["ggx"](), scene)
    path = tmp_path / "ball.exr"
    images.write(path, truth.pixels.images(np.asarray(truth.value), 0.0)[0])
    save_scene(scene, path.with_suffix(".toml"), {"model": "ggx"})
    samples = sphere_exr.load(path)
    assert samples.name == "ball"
    assert samples.channels == ("R", "G", "B")
    for name in ("wi", "wo", "weight", "value", "mask", "cosine"):
        expected = np.asarray(getattr(truth, name))
        np.testing.assert_array_equal(getattr(samples, name), expected)


def test_pixels_that_are_not_finite_are_masked_without_a_warning(tmp_path):
    path = specimens.sphere_exr(tmp_path)
    pixels = images.read(path).pixels
    before = sphere_exr.load(path)
    pixels[5, 5] = np.nan
    pixels[6, 6, 0] = np.inf
    images.write(path, pixels)
    samples = sphere_exr.load(path)
    assert before.mask.sum() - samples.mask.sum() == 4
    assert np.isnan(samples.value).sum() == 3
    images.write(path, np.full_like(pixels, np.nan))
    with pytest.raises(ValueError, match="holds no value that can be used"):
        sphere_exr.load(path)


def test_noise_below_zero_is_kept_because_it_is_radiance(tmp_path):
    path = specimens.sphere_exr(tmp_path)
    before = sphere_exr.load(path)
    images.write(path, -images.read(path).pixels)
    np.testing.assert_array_equal(sphere_exr.load(path).mask, before.mask)


def test_image_and_scene_must_fit(tmp_path):
    path = specimens.sphere_exr(tmp_path)
    sidecar = path.with_suffix(".toml")
    text = sidecar.read_text()
    sidecar.write_text(text.replace("resolution = 12", "resolution = 14"))
    with pytest.raises(ValueError, match="12 x 12 pixels, .* has 14 x 14"):
        sphere_exr.load(path)
    sidecar.write_text(text.replace("resolution = 12", "resolution = 4000000000"))
    with pytest.raises(ValueError, match="`resolution` must be 32768 or below"):
        sphere_exr.load(path)
    sidecar.write_text("[camera\n")
    with pytest.raises(ValueError, match="is not TOML"):
        sphere_exr.load(path)
    sidecar.unlink()
    with pytest.raises(OSError, match="has no scene beside it"):
        sphere_exr.load(path)


def test_an_image_that_unpacks_to_far_more_than_its_file_is_refused(tmp_path):
    path = tmp_path / "black.exr"
    images.write(path, np.zeros((2100, 2100, 3), np.float32))
    save_scene(lit_sphere(2100), path.with_suffix(".toml"))
    with pytest.raises(ValueError, match="times what is in it"):
        sphere_exr.load(path)
    folder = specimens.sphere_photos(tmp_path)
    images.write(folder / "001.png", np.zeros((2100, 2100, 3), np.float32))
    with pytest.raises(ValueError, match="times what is in it"):
        sphere_photos.load(folder)


def test_photographs_of_a_diffuse_ball_have_its_reflectance(tmp_path):
    samples = sphere_photos.load(specimens.sphere_photos(tmp_path))
    assert samples.pixels.shape == (3, 12, 12)
    assert samples.name == "specimen_photos"
    inside = samples.mask & (samples.wo[:, 2:] > 0.5) & (samples.weight[:, 0] > 0.1)
    np.testing.assert_allclose(samples.f_r[inside] * np.pi, 0.5, rtol=0.06)
    lit = samples.weight[:, 0].any(axis=1)
    assert not samples.mask[~lit].any()
    assert (~lit).any()


def test_saturated_channels_are_masked(tmp_path):
    folder = specimens.sphere_photos(tmp_path)
    before = sphere_photos.load(folder)
    picture = images.read(folder / "000.png").pixels
    picture[6, 6, 1] = 1
    images.write(folder / "000.png", picture)
    after = sphere_photos.load(folder)
    changed = before.mask & ~after.mask
    assert changed.sum() == 1
    assert after.value[changed] == pytest.approx(1 / np.pi)


def test_normals_come_from_the_outline_or_from_a_file(tmp_path):
    folder = specimens.sphere_photos(tmp_path, resolution=40)
    outline = sphere_photos.load(folder)
    centre = (2 * np.arange(40) + 1) / 40 - 1
    x, y = np.meshgrid(centre, -centre)
    z = np.sqrt(np.maximum(1 - x * x - y * y, 0))
    normal = np.stack([x, y, z], axis=-1)
    scipy.io.savemat(folder / "Normal_gt.mat", {"Normal_gt": normal})
    given = sphere_photos.load(folder)
    inner = given.wo[:, 2] > 0.5
    np.testing.assert_allclose(given.wo[inner], outline.wo[inner], atol=0.02)
    scipy.io.savemat(folder / "Normal_gt.mat", {"Normal_gt": normal[:-1]})
    with pytest.raises(ValueError, match="as large as the mask"):
        sphere_photos.load(folder)
    (folder / "Normal_gt.mat").write_bytes(b"MATLAB 5.0 MAT-file" + bytes(200))
    with pytest.raises(OSError, match="no complete MATLAB file"):
        sphere_photos.load(folder)


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("light_directions.txt", "0 0 1\n", "3 photographs, but .* has 1 lines"),
        ("light_directions.txt", "0 0 1\n0 0 2\n0 0 1\n", "Light 2 .* unit vector"),
        ("light_directions.txt", "0 0 1\n0 0\n0 0 1\n", "Light 2 .* three numbers"),
        ("light_directions.txt", "0 0 1\n0 0 x\n0 0 1\n", "Light 2 .* Line 2"),
        ("light_intensities.txt", "1 1 1\n", "has 1 lines"),
        ("light_intensities.txt", "1 1\n1 1\n1 1\n", "000.png.*2 channels, but 3"),
        ("filenames.txt", "../../secret.png\n", "Line 1 .* in the same folder"),
        ("filenames.txt", "no.png\nno.png\nno.png\n", "Line 1 .* in the same folder"),
        ("mask.png", "", "is empty"),
        ("001.png", "x", "not a complete PNG"),
    ],
)
def test_a_wrong_folder_is_one_sentence(tmp_path, name, content, sentence):
    folder = specimens.sphere_photos(tmp_path)
    (folder / name).write_text(content)
    with pytest.raises((ValueError, OSError), match=sentence):
        sphere_photos.load(folder)


def test_8_bit_photographs_are_refused(tmp_path):
    folder = specimens.sphere_photos(tmp_path)
    OpenImageIO.ImageBuf(np.ones((12, 12, 3), np.uint8)).write(str(folder / "001.png"))
    with pytest.raises(ValueError, match="8 bits"):
        sphere_photos.load(folder)


def test_a_mask_that_is_no_disc_needs_normals(tmp_path):
    folder = specimens.sphere_photos(tmp_path, resolution=40)
    square = np.zeros((40, 40, 1), np.float32)
    square[5:35, 5:35] = 1
    images.write(folder / "mask.png", square)
    with pytest.raises(ValueError, match="is not a disc"):
        sphere_photos.load(folder)


def test_the_twelve_photographs_keep_their_16_bits():
    folder = shared_data("sphere_photos", "diligent_ball")
    samples = sphere_photos.load(folder)
    assert samples.pixels.shape == (12, 512, 612)
    assert len(samples) == 12 * 15791
    grey = np.round(samples.value.astype(np.float64) * np.pi * 65535)
    np.testing.assert_allclose(samples.value * np.pi * 65535, grey, atol=0.01)
    assert len(np.unique(grey)) > 4000
    saturated = (grey == 65535).all(axis=1)
    assert 0 < saturated.sum() < 200
    assert not samples.mask[saturated].any()
    # Divided by intensity and cosine, the ball is of one diffuse colour.
    facing = (samples.weight[:, 0] > 0.5 * samples.weight[:, 0].max(axis=0)).all(axis=1)
    colour = np.median(samples.f_r[facing], axis=0) * np.pi
    np.testing.assert_allclose(colour, [0.158, 0.134, 0.087], rtol=0.05)


def test_frames_are_joined_in_order(tmp_path):
    samples = sphere_photos.load(specimens.sphere_photos(tmp_path))
    third = samples.take(samples.pixels.frame == 2)
    alone = dataclasses.replace(third, name="x")
    assert len(alone) * 3 == len(samples)
    pictures = samples.pixels.images(samples.value, 0.0)
    assert pictures.shape == (3, 12, 12, 3)
    assert pictures[1][:, -3:].sum() > pictures[1][:, :3].sum()  # light from the right
    assert pictures[2][:3].sum() > pictures[2][-3:].sum()  # light from above


def test_a_stack_joins_its_images(tmp_path):
    folder = specimens.exr_stack(tmp_path)
    stack = exr_stack.load(folder)
    one, other = (sphere_exr.load(folder / f"{name}.exr") for name in "ab")
    assert stack.pixels.shape == (2, 12, 12)
    np.testing.assert_array_equal(stack.value, np.concatenate([one.value, other.value]))
    np.testing.assert_array_equal(stack.wi, np.concatenate([one.wi, other.wi]))
    assert stack.name == "specimen_stack"


def test_images_of_a_stack_must_agree(tmp_path):
    folder = specimens.exr_stack(tmp_path)
    path = specimens.sphere_exr(tmp_path, resolution=14)
    for suffix in (".exr", ".toml"):
        path.with_suffix(suffix).rename(folder / f"c{suffix}")
    with pytest.raises(ValueError, match="must agree in size"):
        exr_stack.load(folder)
