import re

import numpy as np
import OpenImageIO
import pytest

from brdffit import images


def picture(rows=5, columns=4, channels=3, seed=0):
    return np.random.default_rng(seed).random((rows, columns, channels), np.float32)


def test_exr_keeps_every_bit_of_float32(tmp_path):
    image = picture()
    image[0, :, 0] = [-3.5, 1e-40, 3e38, 0.1]
    images.write(tmp_path / "a.exr", image)
    again, channels = images.read(tmp_path / "a.exr")
    assert channels == ("R", "G", "B")
    np.testing.assert_array_equal(again, image)


@pytest.mark.parametrize(
    "channels",
    [("Y",), ("R", "G", "B", "A"), ("400nm", "550nm", "1000nm"), tuple("0123456789")],
)
def test_exr_keeps_names_and_order_of_channels(tmp_path, channels):
    image = picture(channels=len(channels))
    images.write(tmp_path / "a.exr", image, channels)
    again = images.read(tmp_path / "a.exr")
    assert again.channels == channels
    np.testing.assert_array_equal(again.pixels, image)


def test_more_than_nine_unnamed_channels_stay_in_order(tmp_path):
    image = picture(channels=12)
    images.write(tmp_path / "a.exr", image)
    np.testing.assert_array_equal(images.read(tmp_path / "a.exr").pixels, image)


@pytest.mark.parametrize("suffix", [".png", ".tif", ".tiff"])
def test_all_65536_levels_of_16_bits_survive(tmp_path, suffix):
    levels = np.arange(65536, dtype=np.float64) / 65535
    image = levels.astype(np.float32).reshape(256, 256, 1)
    path = tmp_path / f"levels{suffix}"
    images.write(path, image)
    np.testing.assert_array_equal(images.read(path).pixels, image)


def test_alpha_is_not_multiplied_into_the_colours_of_a_png(tmp_path):
    path = str(tmp_path / "a.png")
    stored = np.full((2, 2, 4), 40000, np.uint16)
    spec = OpenImageIO.ImageSpec(2, 2, 4, "uint16")
    spec.attribute("oiio:UnassociatedAlpha", 1)
    target = OpenImageIO.ImageOutput.create(path)
    assert target.open(path, spec)
    assert target.write_image(stored)
    assert target.close()
    np.testing.assert_array_equal(
        images.read(path).pixels, np.float32(np.float64(40000) / 65535)
    )


def test_radiance_hdr_is_right_to_one_part_in_128_of_the_largest_channel(tmp_path):
    image = picture(rows=20, columns=20) * 1000
    images.write(tmp_path / "a.hdr", image)
    again = images.read(tmp_path / "a.hdr").pixels
    largest = image.max(axis=-1, keepdims=True)
    assert np.abs(again - image).max() > 0
    assert (np.abs(again - image) / largest).max() < 1 / 128


def test_photographs_with_8_bits_are_refused_but_serve_as_masks(tmp_path):
    image = np.zeros((3, 4, 3), np.float32)
    image[1, 2] = 1
    images.write_preview(tmp_path / "a.png", image)
    with pytest.raises(ValueError, match="has 8 bits a channel"):
        images.read(tmp_path / "a.png")
    np.testing.assert_array_equal(
        images.read_mask(tmp_path / "a.png"), image[..., 0] > 0
    )


def test_a_mask_is_where_a_colour_is_not_where_it_is_opaque(tmp_path):
    image = picture(channels=4)
    image[:, :, :3] = 0
    image[2, 1, 1] = 0.5
    images.write(tmp_path / "a.exr", image, ("R", "G", "B", "A"))
    np.testing.assert_array_equal(
        images.read_mask(tmp_path / "a.exr"), image[..., 1] > 0
    )


@pytest.mark.parametrize("suffix", [".exr", ".hdr", ".png", ".tif"])
def test_truncated_files_give_one_sentence_and_decoders_are_quiet(
    tmp_path, capfd, suffix
):
    whole, cut = tmp_path / f"whole{suffix}", tmp_path / f"cut{suffix}"
    images.write(whole, picture(rows=40, columns=40))
    content = whole.read_bytes()
    for length in (3, 60, len(content) // 3, len(content) - 30):
        cut.write_bytes(content[:length])
        with pytest.raises(OSError, match=re.escape(f"Image `{cut}` is not a compl")):
            images.read(cut)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("none.exr", None, "Image `.*none.exr` does not exist."),
        ("empty.png", b"", "Image `.*empty.png` is empty."),
        ("noise.tif", b"not an image" * 9, "is not a complete TIF file."),
        ("noise.exr", b"not an image" * 9, "is not a complete EXR file."),
        ("noise.jpg", b"not an image" * 9, "must end in .exr, .hdr, .png, .tif, .tiff"),
    ],
)
def test_files_that_are_no_image_give_one_sentence(tmp_path, name, content, sentence):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises((OSError, ValueError), match=sentence):
        images.read(tmp_path / name)


def test_pixels_that_are_not_finite_are_counted_aloud_and_kept(tmp_path):
    image = picture()
    image[0, 0, 0], image[1, 1] = np.nan, np.inf
    images.write(tmp_path / "a.exr", image)
    with pytest.warns(UserWarning, match="has 2 pixels that are not finite"):
        again = images.read(tmp_path / "a.exr").pixels
    np.testing.assert_array_equal(again, image)


@pytest.mark.parametrize(
    ("name", "image", "sentence"),
    [
        ("a.png", picture() + 1, "has values that PNG cannot hold"),
        ("a.tif", picture() - 1, "has values that TIF cannot hold"),
        ("a.hdr", picture() * np.nan, "has values that HDR cannot hold"),
        ("a.png", picture(channels=2), "has 2 channels: write it as EXR"),
        ("a.hdr", picture(channels=1), "has 1 channels: write it as EXR"),
        ("a.gif", picture(), "must end in"),
    ],
)
def test_values_that_a_format_cannot_hold_are_refused(tmp_path, name, image, sentence):
    with pytest.raises(ValueError, match=sentence):
        images.write(tmp_path / name, image)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("channels", [("R", "G", "G"), ("R",), ("R", "G", "B", "B")])
def test_channels_need_as_many_different_names(tmp_path, channels):
    with pytest.raises(ValueError, match="a name for each of its 3 channels"):
        images.write(tmp_path / "a.exr", picture(), channels)


@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_a_folder_that_is_none_gives_one_sentence(tmp_path, suffix):
    path = tmp_path / "nowhere" / f"a{suffix}"
    with pytest.raises(OSError, match="cannot be written: .* is not a folder"):
        images.write(path, picture())


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "a.exr"
    images.write(path, picture())
    before = path.read_bytes()

    def fail(*_):
        raise RuntimeError("disk is full")

    monkeypatch.setattr(images.OpenEXR, "File", fail)
    with pytest.raises(OSError, match=r"a.exr` cannot be written: .*disk is full"):
        images.write(path, picture(seed=1))
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_preview_is_srgb_of_the_linear_values():
    linear = np.array([-1, 0, 0.0031308, 0.18, 0.5, 1, 7, np.nan], np.float32)
    shown = images.preview(linear.reshape(1, -1, 1) * np.ones(3, np.float32))
    # IEC 61966-2-1: 12.92 v, then 1.055 v^(1 / 2.4) - 0.055, times 255
    expected = [0, 0, 10, 118, 188, 255, 255, 0]
    np.testing.assert_array_equal(shown[0], np.repeat([expected], 3, axis=0).T)


def test_preview_shows_other_numbers_of_channels_as_grey():
    image = np.array([[[0.1, 0.3]]], np.float32)
    grey = images.preview(np.full((1, 1, 3), 0.2, np.float32))
    np.testing.assert_array_equal(images.preview(image), grey)


def test_preview_is_an_8_bit_png(tmp_path):
    path = tmp_path / "a.png"
    images.write_preview(path, picture(), exposure=0.5)
    source = OpenImageIO.ImageInput.open(str(path))
    assert str(source.spec().format) == "uint8"
    np.testing.assert_array_equal(
        source.read_image("uint8"), images.preview(picture() * np.float32(0.5))
    )


def test_colour_science_leaves_the_way_numpy_prints_alone():
    images.preview(picture())
    assert str(np.float32(1 / 3)) == "0.33333334"
