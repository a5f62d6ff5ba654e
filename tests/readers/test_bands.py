import numpy as np
import OpenImageIO
import pytest

from brdffit import images
from brdffit.readers.bands import Photograph


@pytest.fixture
def pixels():
    return np.random.default_rng(0).random((20, 30, 3), np.float32)


@pytest.mark.parametrize("suffix", [".exr", ".hdr", ".png", ".tif"])
def test_bands_together_are_the_image(tmp_path, pixels, suffix):
    path = tmp_path / f"a{suffix}"
    images.write(path, pixels)
    photograph = Photograph(path)
    assert photograph.shape == (20, 30)
    assert photograph.channels == ("R", "G", "B")
    assert photograph.full == (1 if suffix in images.INTEGER else np.inf)
    bands = [photograph.rows(first, min(first + 8, 20)) for first in (0, 8, 16)]
    np.testing.assert_array_equal(np.concatenate(bands), images.read(path).pixels)
    np.testing.assert_array_equal(photograph.rows(3, 5), np.concatenate(bands)[3:5])


def test_a_tiled_exr_is_read_as_well(tmp_path, pixels):
    path = tmp_path / "tiled.exr"
    spec = OpenImageIO.ImageSpec(30, 20, 3, "float")
    spec.tile_width = spec.tile_height = 16
    target = OpenImageIO.ImageOutput.create(str(path))
    assert target.open(str(path), spec)
    assert target.write_image(pixels)
    assert target.close()
    np.testing.assert_array_equal(Photograph(path).rows(7, 19), pixels[7:19])


def test_alpha_is_no_channel_of_a_photograph(tmp_path, pixels):
    path = tmp_path / "cut_out.exr"
    images.write(path, np.dstack([pixels, pixels[..., :1]]), ("R", "G", "B", "A"))
    photograph = Photograph(path)
    assert photograph.channels == ("R", "G", "B")
    np.testing.assert_array_equal(photograph.rows(2, 9), pixels[2:9])


@pytest.mark.parametrize("suffix", [".exr", ".png", ".tif"])
def test_a_file_that_was_cut_off_is_one_sentence(tmp_path, pixels, suffix):
    path = tmp_path / f"cut{suffix}"
    images.write(path, pixels)
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 6 // 10])
    with pytest.raises(OSError, match=r"`.*cut\..*` (ends before|is not a complete)"):
        Photograph(path).rows(0, 20)


def test_files_that_are_no_photographs_are_refused(tmp_path):
    with pytest.raises(OSError, match="does not exist"):
        Photograph(tmp_path / "no.exr")
    (tmp_path / "a.jpg").write_bytes(b"x")
    with pytest.raises(ValueError, match="must end in .exr"):
        Photograph(tmp_path / "a.jpg")
    few = tmp_path / "few.png"
    OpenImageIO.ImageBuf(np.ones((4, 4, 3), np.uint8)).write(str(few))
    with pytest.raises(ValueError, match="8 bits a channel"):
        Photograph(few)
    empty = tmp_path / "empty.exr"
    images.write(empty, np.zeros((9000, 9000, 1), np.float32))
    with pytest.raises(ValueError, match="empty.exr` claims 81000000 numbers"):
        Photograph(empty)
