import numpy as np
import pytest
import zarr

from brdffit import MODELS, images, load
from brdffit.batch import photographs
from brdffit.batch.photographs import source_of, write_stack
from brdffit.batch.stack import ZarrStack
from brdffit.readers.capture import open_capture
from brdffit.render import shade_texels
from tests import wall
from tests.readers import specimens

SHAPE = (10, 12)


def stack_of(folder, target):
    write_stack(open_capture(folder), target)
    stack = ZarrStack(target)
    return stack.read(0, stack.texels), zarr.open_group(target, mode="r")


@pytest.fixture
def folder(tmp_path):
    wall.photograph(tmp_path / "wall")
    return tmp_path / "wall"


def test_the_true_parameters_explain_every_value(tmp_path, folder):
    texels, group = stack_of(folder, tmp_path / "stack.zarr")
    truth = {n: m.reshape(120, -1).T.astype("f4") for n, m in wall.maps().items()}
    found = shade_texels(MODELS["ggx"](), truth, texels.wi, texels.wo, texels.weight)
    np.testing.assert_allclose(found, texels.value, rtol=1e-4, atol=1e-6)
    np.testing.assert_array_equal(group["pixel"], np.arange(120))
    assert texels.mask.all()
    assert texels.weight.shape[1] == 1, "lights are white"
    assert dict(group.attrs)["shape"] == [10, 12]
    assert dict(group.attrs)["photographs"][0] == "00.exr"


def test_bands_of_rows_make_no_difference(tmp_path, folder, monkeypatch):
    whole, _ = stack_of(folder, tmp_path / "whole.zarr")
    monkeypatch.setattr(photographs, "BAND", 40)  # pixels, three rows
    parts, group = stack_of(folder, tmp_path / "parts.zarr")
    assert group["value"].chunks[-1] == 40
    for name in ("wi", "wo", "weight", "value", "mask"):
        np.testing.assert_array_equal(getattr(parts, name), getattr(whole, name))


def test_texels_are_the_pixels_of_the_mask(tmp_path, folder):
    mask = np.zeros((*SHAPE, 1), np.float32)
    mask[2:4, 5:9] = 1
    images.write(folder / "mask.png", mask)
    _, group = stack_of(folder, tmp_path / "stack.zarr")
    np.testing.assert_array_equal(group["pixel"], [29, 30, 31, 32, 41, 42, 43, 44])
    images.write(folder / "mask.png", 0 * mask)
    with pytest.raises(ValueError, match="holds no texel that can be used"):
        stack_of(folder, tmp_path / "none.zarr")
    assert not list(tmp_path.glob("*none*")), "nothing left behind"


def test_a_normal_map_tilts_the_frames(tmp_path, folder):
    plain, _ = stack_of(folder, tmp_path / "plain.zarr")
    tilt = np.broadcast_to(np.float32([0.6, 0, 0.8]), (*SHAPE, 3))
    images.write(folder / "normals.exr", tilt, ("X", "Y", "Z"))
    tilted, _ = stack_of(folder, tmp_path / "tilted.zarr")
    # the plane faces +z, so its local frame is that of the world
    wanted = np.einsum("k,okt->ot", [0.6, 0, 0.8], plain.wo)
    np.testing.assert_allclose(tilted.wo[:, 2], wanted, atol=1e-6)
    images.write(folder / "normals.exr", 0.9 * tilt, ("X", "Y", "Z"))
    with pytest.raises(
        ValueError, match="unit vectors, but that of row 0, column 0 .* 0.9"
    ):
        stack_of(folder, tmp_path / "short.zarr")


def test_what_is_saturated_or_not_finite_is_masked(tmp_path):
    folder = tmp_path / "wall"
    wall.photograph(folder, lights=3, suffix=".png")
    picture = images.read(folder / "01.png").pixels
    picture[4, 5, 1] = 1
    images.write(folder / "01.png", picture)
    texels, _ = stack_of(folder, tmp_path / "stack.zarr")
    assert not texels.mask[1, 1, 4 * 12 + 5]
    assert texels.mask.sum() == texels.mask.size - 1
    assert np.isfinite(texels.value).all()


def test_photographs_of_a_ball_are_what_its_reader_reads(tmp_path):
    folder = specimens.sphere_photos(tmp_path)
    texels, group = stack_of(folder, tmp_path / "stack.zarr")
    samples = load(folder)
    where = samples.pixels
    for number in range(3):
        here = where.frame == number
        pixel = (where.row * 12 + where.column)[here]
        place = np.searchsorted(pixel, group["pixel"])
        for name in ("wi", "weight"):
            wanted = getattr(samples, name)[here][place][:, 0].T
            np.testing.assert_allclose(getattr(texels, name)[number], wanted, atol=1e-6)
        mask = samples.mask[here][place].T
        np.testing.assert_array_equal(texels.mask[number], mask)
        value = np.where(mask, samples.value[here][place].T, 0)
        np.testing.assert_allclose(texels.value[number], value, rtol=1e-6)


def test_a_photograph_that_is_cut_off_leaves_nothing_behind(tmp_path, folder):
    path = folder / "05.exr"
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(OSError, match="05.exr"):
        write_stack(open_capture(folder), tmp_path / "out" / "stack.zarr")
    assert not (tmp_path / "out").exists()


def test_the_hash_of_the_source_sees_pixels_and_lights(folder):
    before = source_of(open_capture(folder))
    assert source_of(open_capture(folder)) == before
    picture = images.read(folder / "03.exr").pixels
    images.write(folder / "03.exr", picture * 1.0001)
    changed = source_of(open_capture(folder))
    scene = folder / "scene.toml"
    scene.write_text(scene.read_text().replace("intensity = 4.0", "intensity = 4.1", 1))
    assert len({before, changed, source_of(open_capture(folder))}) == 3
