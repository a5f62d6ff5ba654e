import mitsuba
import numpy as np
import pytest

from brdffit.readers import rgl, tensor_file
from brdffit.readers.adaptive_warp import Warp
from tests.data import shared_data
from tests.readers import specimens

REFERENCE = (
    "paper_white_rgb",
    "vch_golden_yellow_rgb",
    "cm_military_green_rgb",
    "chm_mint_rgb",
    "irid_flake_paint1_rgb",
)


def pairs(count=200, seed=3):
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(2, count, 3))
    w[..., 2] = np.abs(w[..., 2]) + 0.05
    return w / np.linalg.norm(w, axis=-1, keepdims=True)


@pytest.mark.parametrize("name", REFERENCE)
def test_evaluation_agrees_with_an_independent_renderer(name):
    reference = np.load(shared_data("rgl", "reference_eval.npz"))
    path = shared_data("rgl", f"{name}.bsdf")
    f_r = rgl.evaluate(path, reference["wi"], reference["wo"])
    error = np.abs(f_r / reference[name] - 1)
    assert f_r.shape == (933, 3)
    assert error.max() < 1e-3
    assert np.median(error) < 1e-5


def inner_nodes(measured, width):
    """Nodes off the rim of the table, where angles wrap, and above the horizon."""
    row, column = np.divmod(np.arange(len(measured)) % width**2, width)
    rim = (row % (width - 1) == 0) | (column % (width - 1) == 0)
    return ~rim & (measured.wi[:, 2] > 0.05) & (measured.wo[:, 2] > 0.05)


@pytest.mark.parametrize("name", REFERENCE)
def test_measured_points_are_where_the_material_has_their_values(name):
    path = shared_data("rgl", f"{name}.bsdf")
    measured = rgl.load(path)
    assert len(measured) == 8 * 32 * 32
    nodes = inner_nodes(measured, 32)
    f_r = rgl.evaluate(path, measured.wi[nodes], measured.wo[nodes])
    np.testing.assert_allclose(f_r, measured.f_r[nodes], rtol=1e-5)


def test_solid_angles_integrate_white_paper_to_its_albedo():
    measured = rgl.load(shared_data("rgl", "paper_white_rgb.bsdf"))
    first = slice(0, 32 * 32)  # light from the normal
    size = measured.solid_angle[first]
    assert size.sum() == pytest.approx(2 * np.pi, rel=0.05)
    value = np.where(measured.mask[first], measured.f_r[first], 0)
    albedo = np.sum(value * measured.wo[first][:, 2:] * size[:, None], axis=0)
    assert (0.75 < albedo).all()
    assert (albedo < 1).all()


def test_colours_outside_of_the_gamut_are_kept_and_masked():
    measured = rgl.load(shared_data("rgl", "chm_mint_rgb.bsdf"))
    assert measured.f_r.min() < -100
    assert not measured.mask[measured.f_r < 0].any()
    assert measured.name.startswith("TeckWrap")


@pytest.mark.parametrize("azimuths", [1, 5])
def test_nodes_of_isotropic_and_anisotropic_files_agree_with_evaluation(
    azimuths, tmp_path
):
    path = specimens.rgl(tmp_path, azimuths, wavelengths=(400, 500))
    measured = rgl.load(path)
    assert measured.channels == ("400 nm", "500 nm")
    assert len(measured) == azimuths * 4 * 36
    assert measured.f_r.dtype == np.float32
    nodes = inner_nodes(measured, 6)
    if azimuths > 1:
        nodes &= measured.wi[:, 2] < 0.99  # where an azimuth is defined
    f_r = rgl.evaluate(path, measured.wi[nodes], measured.wo[nodes])
    np.testing.assert_allclose(f_r, measured.f_r[nodes], rtol=1e-5)


def test_an_isotropic_material_looks_the_same_when_turned(tmp_path):
    path = specimens.rgl(tmp_path)
    wi, wo = pairs()
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    np.testing.assert_allclose(
        rgl.evaluate(path, wi, wo), rgl.evaluate(path, wi @ turn, wo @ turn), rtol=1e-9
    )


@pytest.mark.parametrize(("azimuths", "parts"), [(5, 1), (5, 2), (4, 4)])
def test_anisotropic_files_agree_with_mitsuba(azimuths, parts, tmp_path):
    mitsuba.set_variant("scalar_rgb")
    path = specimens.rgl(tmp_path, azimuths, parts=parts)
    plugin = mitsuba.load_dict({"type": "measured", "filename": str(path)})
    wi, wo = pairs(60)
    ours = rgl.evaluate(path, wi, wo) * wo[:, 2:]
    interaction = mitsuba.SurfaceInteraction3f()
    context = mitsuba.BSDFContext()
    for index in range(len(wi)):
        interaction.wi = mitsuba.Vector3f(*wi[index])
        theirs = plugin.eval(context, interaction, mitsuba.Vector3f(*wo[index]))
        np.testing.assert_allclose(ours[index], np.array(theirs), rtol=2e-3)


def test_below_the_horizon_is_black(tmp_path):
    path = specimens.rgl(tmp_path)
    wi, wo = pairs(4)
    assert not rgl.evaluate(path, -wi, wo).any()
    assert not rgl.evaluate(path, wi, -wo).any()


def test_the_warp_and_its_inverse_undo_each_other():
    rng = np.random.default_rng(0)
    warp = Warp(rng.uniform(0.1, 2, (3, 7, 9)), np.arange(3.0))
    uniform = rng.uniform(0, 1, (500, 2))
    for index in range(3):
        slices = warp.slices(np.full(500, float(index)))
        back = warp.invert(warp.sample(uniform, index), slices)
        np.testing.assert_allclose(back, uniform, atol=1e-12)


def test_the_warp_puts_points_where_the_density_is():
    ramp = np.tile(np.linspace(0, 1, 11), (5, 1))
    warp = Warp(ramp[None], np.zeros(1))
    grid = (np.arange(100) + 0.5) / 100
    uniform = np.stack([grid, np.full(100, 0.5)], axis=1)
    points = warp.sample(uniform, 0)
    np.testing.assert_allclose(points[:, 0], np.sqrt(grid), atol=1e-12)
    np.testing.assert_allclose(points[:, 1], 0.5)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"rgb": None}, "no array `rgb`"),
        ({"vndf": None}, "no array `vndf`"),
        ({"ndf": np.ones((1, 8), "f4")}, "smaller than 2 x 2"),
        ({"theta_i": np.ones(4, "f4")}, "`theta_i` does not increase"),
        ({"theta_i": np.full(4, np.nan, "f4")}, "`theta_i` does not increase"),
        ({"vndf": np.ones((1, 3, 8, 8), "f4")}, "`vndf` has shape"),
        ({"vndf": np.zeros((1, 4, 8, 8), "f4")}, "is no density"),
        ({"vndf": -np.ones((1, 4, 8, 8), "f4")}, "is no density"),
        ({"vndf": np.ones((1, 4, 8, 8), "u1")}, "`vndf` has shape"),
    ],
)
def test_a_wrong_array_is_one_sentence(change, sentence, tmp_path):
    fields = dict(tensor_file.read(specimens.rgl(tmp_path)))
    fields.update(change)
    fields = {name: array for name, array in fields.items() if array is not None}
    path = specimens.tensor_file(tmp_path / "a.bsdf", fields)
    with pytest.raises(ValueError, match=f"not a complete RGL material.*{sentence}"):
        rgl.load(path)


def test_a_tensor_file_with_huge_counts_is_refused(tmp_path):
    content = bytearray(specimens.rgl(tmp_path).read_bytes())
    path = tmp_path / "huge.bsdf"
    for position in (14, 18, 18 + 2 + 11 + 11):  # fields, length of a name, a size
        broken = content.copy()
        broken[position : position + 2] = b"\xff\xff"
        path.write_bytes(broken)
        with pytest.raises(ValueError, match="damaged or cut off|is cut off|no array"):
            rgl.load(path)
