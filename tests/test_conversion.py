import numpy as np
import pytest

import brdffit
from brdffit.conversion import convert
from brdffit.exports import export
from brdffit.readers import merl, rgl
from brdffit.samples import pick_channels
from tests.data import shared_data
from tests.readers import specimens


def test_a_measurement_becomes_a_table_with_all_its_values(tmp_path):
    source = specimens.fred(tmp_path)
    data, out = brdffit.load(source), tmp_path / "out.csv"
    assert "18 pairs" in convert(source, data, out)
    back = brdffit.load(out)
    assert np.array_equal(back.f_r, data.f_r)
    assert np.array_equal(back.mask, data.mask)
    assert "# origin: converted from specimen.txt" in out.read_text()


def test_pixels_under_one_light_become_pairs_of_directions(tmp_path):
    source = specimens.sphere_exr(tmp_path)
    data, out = brdffit.load(source), tmp_path / "out.csv"
    convert(source, data, out)
    back = brdffit.load(out)
    use = data.mask & np.isfinite(data.f_r)
    assert np.array_equal(back.mask, use & (data.wi[:, 0, 2:] > 1e-6))
    assert np.allclose(back.f_r[back.mask], data.f_r[back.mask])


def test_an_rgl_material_becomes_merl_cells_within_what_was_measured(tmp_path):
    source = shared_data("rgl", "paper_white_rgb.bsdf")
    data, out = brdffit.load(source), tmp_path / "paper.binary"
    convert(source, data, out)
    back = brdffit.load(out)
    steepest = data.wi[:, 2].min()
    assert back.wi[back.mask[:, 0], 2].min() >= steepest
    rows = np.flatnonzero(back.mask.all(axis=1))[::20011]
    expected = rgl.evaluate(source, back.wi[rows], back.wo[rows])
    assert np.allclose(back.f_r[rows], expected, rtol=1e-12)


def test_a_merl_material_becomes_a_sphere(tmp_path):
    brdf = brdffit.MODELS["lambert"](albedo=[0.8, 0.4, 0.2])
    source, out = tmp_path / "chalk.binary", tmp_path / "chalk.exr"
    export(brdf, "merl", source)
    convert(source, merl.load(source), out)
    image = brdffit.load(out)
    expected = np.array([0.8, 0.4, 0.2]) / np.pi
    assert np.allclose(image.f_r[image.mask[:, 0]], expected)
    pixels = image.value[image.mask]
    assert np.mean(image.mask) > 0.7
    assert pixels.max() == pytest.approx(0.8, abs=1e-3)  # faces a light of pi


def test_an_image_has_the_channels_of_the_data(tmp_path):
    source = shared_data("rgl", "paper_white_rgb.bsdf")
    data = pick_channels(brdffit.load(source), ["G"])
    convert(source, data, tmp_path / "paper.exr")
    image = brdffit.load(tmp_path / "paper.exr")
    assert image.channels == ("G",)
    wi, wo = (np.asarray(w[::501], float) for w in (image.wi[:, 0], image.wo))
    expected = rgl.evaluate(source, wi, wo)[:, 1] * np.asarray(
        image.weight[::501, 0, 0]
    )
    assert np.allclose(image.value[::501, 0], expected, rtol=1e-3, atol=1e-3)


@pytest.mark.parametrize("suffix", [".binary", ".exr"])
def test_single_pairs_do_not_fill_a_grid_or_an_image(suffix, tmp_path):
    source = specimens.fred(tmp_path)
    with pytest.raises(ValueError, match="do not fill a grid or an image"):
        convert(source, brdffit.load(source), tmp_path / f"x{suffix}")


def test_an_unknown_suffix_is_refused(tmp_path):
    source = specimens.fred(tmp_path)
    with pytest.raises(ValueError, match="must end in .csv, .binary, .exr"):
        convert(source, brdffit.load(source), tmp_path / "x.xyz")
