import json

import numpy as np
import pytest

from brdffit import images
from brdffit.batch.stack import save_stack
from brdffit.batch.surface import open_surface
from brdffit.batch.svbrdf import svbrdf
from tests import wall


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A small wall, one of its photographs held out."""
    folder = tmp_path_factory.mktemp("svbrdf")
    truth = wall.photograph(folder / "wall", lights=16, noise=0.005)
    done = svbrdf("ggx", folder / "wall", folder / "out", hold_out="05.exr")
    return folder, truth, done


def read(folder, name):
    return images.read(folder / "out" / "maps" / f"{name}.exr").pixels


def test_maps_are_the_truth_within_their_errors(run):
    folder, truth, _ = run
    for name, wanted in truth.items():
        found, error = read(folder, name), read(folder, f"{name}_error")
        assert found.shape == error.shape == wanted.shape
        deviation = np.abs(found - wanted) / np.maximum(error, 1e-4)
        assert np.median(deviation) < 1.5, name
    assert np.median(np.abs(read(folder, "alpha") - truth["alpha"])) < 0.01


def test_the_photograph_that_was_held_out_is_predicted_to_its_noise(run):
    folder, _, done = run
    error = done.summary["held_out"]["relative_rms"]
    assert done.summary["held_out"]["photograph"] == "05.exr"
    assert 0.003 < error < 0.03
    predicted = images.read(folder / "out" / "held_out.exr").pixels
    photograph = images.read(folder / "wall" / "05.exr").pixels
    by_hand = np.sqrt(np.sum((predicted - photograph) ** 2) / np.sum(photograph**2))
    assert error == pytest.approx(by_hand, rel=1e-4)


def test_the_summary_is_the_numbers_of_the_maps(run):
    folder, _, done = run
    summary = json.loads((folder / "out" / "summary.json").read_text())
    assert summary == done.summary
    assert summary["observations"] == 15
    assert summary["texels"] == done.tally.total == 120
    assert summary["converged"] == pytest.approx(read(folder, "converged").mean())
    wanted = np.median(read(folder, "diffuse"), axis=(0, 1))
    assert summary["parameters"]["diffuse"]["median"] == pytest.approx(wanted)
    for path in [*done.maps, *done.files]:
        assert path.stat().st_size > 0


def test_a_run_goes_on_with_resume_only(run):
    folder, _, done = run
    before = read(folder, "alpha")
    with pytest.raises(
        FileExistsError, match="holds an earlier run: go on .* --resume"
    ):
        svbrdf("ggx", folder / "wall", folder / "out", hold_out="05.exr")
    again = svbrdf(
        "ggx", folder / "wall", folder / "out", hold_out="05.exr", resume=True
    )
    assert (again.tally.kept, again.tally.done) == (120, 0)
    np.testing.assert_array_equal(read(folder, "alpha"), before)


def test_a_parameter_that_is_fixed_stays_in_every_texel(run, tmp_path):
    folder, *_ = run
    done = svbrdf("ggx", folder / "wall", tmp_path / "out", fixed={"alpha": 0.3})
    assert "held_out" not in done.summary
    np.testing.assert_allclose(read(tmp_path, "alpha"), 0.3)
    np.testing.assert_allclose(read(tmp_path, "alpha_error"), 0)


def test_a_zarr_group_of_texels_is_a_source_as_well(run, tmp_path):
    folder, *_ = run
    surface = open_surface(folder / "wall", folder / "out" / "stack.zarr")
    texels = surface.stack.read(0, 24)
    save_stack(tmp_path / "texels.zarr", [texels], shape=(2, 12))
    done = svbrdf("ggx", tmp_path / "texels.zarr", tmp_path / "out", hold_out="6")
    assert done.summary["held_out"]["photograph"] == "6"
    assert read(tmp_path, "diffuse").shape == (2, 12, 3)
    # the last of the rows of a block are those of other texels, to rounding
    whole = read(folder, "diffuse")[:2]
    np.testing.assert_allclose(read(tmp_path, "diffuse"), whole, atol=2e-3)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ({"model": "gxx"}, "Model `gxx` .*`ggx`"),
        ({"hold_out": "5.exr"}, "Photograph `5.exr` must be one of .*Did you mean"),
        ({"hold_out": "17"}, "Photograph `17` must be one of 00.exr"),
        ({"source": "nothing"}, "nothing` is neither a folder of photographs"),
    ],
)
def test_what_cannot_be_is_one_sentence_and_leaves_nothing(
    run, tmp_path, words, sentence
):
    folder, *_ = run
    model = words.get("model", "ggx")
    source = folder / words.get("source", "wall")
    with pytest.raises(ValueError, match=sentence):
        svbrdf(model, source, tmp_path / "out", hold_out=words.get("hold_out"))
    assert not (tmp_path / "out").exists()
