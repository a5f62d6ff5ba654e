"""Every texel is fitted once, in chunks, and a later run knows which."""

import shutil

import numpy as np
import pytest

import brdffit
from brdffit.batch import ledger
from brdffit.batch.texture import FITS, import_zarr
from brdffit.fit.texture import fit_texels
from tests.batch.wall import CHUNK, fit, numbers, same, texels, wall


@pytest.fixture(scope="module")
def stack(tmp_path_factory):
    """Five chunks, the last not full."""
    return wall(tmp_path_factory.mktemp("stack") / "wall.zarr", 5, short=100)


@pytest.fixture(scope="module")
def finished(stack, tmp_path_factory):
    """A run that nothing disturbed."""
    out, seen = tmp_path_factory.mktemp("run") / "out", []
    tally = fit(stack, out, on_progress=lambda t: seen.append(t.done))
    assert (tally.kept, tally.done) == (0, stack.texels)
    assert seen == sorted(seen)
    assert len(seen) == 5
    return out


@pytest.fixture
def copy(finished, tmp_path):
    """That run, in a folder of its own."""
    return shutil.copytree(finished, tmp_path / "out")


def test_a_run_gives_what_the_engine_gives_at_once(stack, finished):
    whole = fit_texels("lambert", stack.read(0, stack.texels), threads=1)
    found = numbers(finished)
    for name in ("rms", "converged", "steps", "at_bound"):
        np.testing.assert_array_equal(found[name], getattr(whole, name))
    for name in whole.parameters:
        for part in ("parameters", "standard_errors"):
            expected = getattr(whole, part)[name]
            np.testing.assert_array_equal(found[f"{part}/{name}"], expected)


def test_the_group_says_what_it_holds(stack, finished):
    group = import_zarr().open_group(finished / FITS, mode="r")
    attributes = dict(group.attrs)
    assert attributes["model"] == "lambert"
    assert (attributes["texels"], attributes["channels"]) == (stack.texels, 3)
    assert group["parameters/albedo"].chunks == (3, CHUNK)
    files = [p for p in (finished / FITS / "at_bound" / "c").iterdir()]
    assert len(files) == 5  # one file a chunk, even where all is false


def test_what_is_finished_is_kept(stack, copy, finished):
    tally = fit(stack, copy, resume=True)
    assert (tally.kept, tally.done) == (stack.texels, 0)
    same(copy, finished)


def test_a_corrupted_chunk_is_found_by_its_checksum_and_done_again(
    stack, copy, finished
):
    path = copy / FITS / "parameters" / "albedo" / "c" / "0" / "2"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    (copy / FITS / "rms" / "c" / "3").unlink()
    tally = fit(stack, copy, resume=True)
    assert tally.done == 2 * CHUNK
    same(copy, finished)


def test_texels_that_changed_are_done_again(copy, tmp_path):
    changed = wall(tmp_path / "wall.zarr", 5, short=100)
    value = import_zarr().open_group(changed.path)["value"]
    value[0, 0, 3] = 2 * value[0, 0, 3]
    tally = fit(changed, copy, resume=True)
    assert tally.done == CHUNK
    assert tally.kept == changed.texels - CHUNK


def test_another_option_or_version_is_done_again(stack, copy, monkeypatch):
    tally = fit(stack, copy, resume=True, residual="plain")
    assert tally.kept == 0
    monkeypatch.setattr(ledger, "version", lambda _: "99.0")
    tally = fit(stack, copy, resume=True, residual="plain")
    assert tally.kept == 0


def test_a_run_of_another_layout_is_left_alone(stack, copy, finished):
    with pytest.raises(ValueError, match="holds a run with model lambert, not phong"):
        brdffit.fit_texture("phong", stack, copy, resume=True, chunk=CHUNK)
    with pytest.raises(ValueError, match="chunk 256, not 128"):
        brdffit.fit_texture("lambert", stack, copy, resume=True, chunk=128)
    with pytest.raises(FileExistsError, match="--resume"):
        fit(stack, copy)
    same(copy, finished)


def test_texels_in_memory_can_be_fitted_but_not_sent_to_a_cluster(tmp_path):
    data = texels(2 * CHUNK)
    assert fit(data, tmp_path / "out").done == 2 * CHUNK
    with pytest.raises(ValueError, match="must be small"):
        fit(texels(5000), tmp_path / "other", cluster="tcp://127.0.0.1:9")


def test_bad_words_are_refused_before_anything_is_written(stack, tmp_path):
    out = tmp_path / "out"
    with pytest.raises(ValueError, match="Did you mean `lambert`"):
        brdffit.fit_texture("lamberd", stack, out)
    with pytest.raises(ValueError, match="Residual"):
        fit(stack, out, residual="logg")
    with pytest.raises(ValueError, match="albedo"):
        fit(stack, out, fixed={"albedo": 7.0})
    with pytest.raises(ValueError, match="must be a zarr group"):
        fit(tmp_path / "nothing.zarr", out)
    assert not out.exists()


def test_held_parameters_are_held(stack, tmp_path):
    fit(stack, tmp_path / "out", fixed={"albedo": 0.25})
    np.testing.assert_array_equal(
        numbers(tmp_path / "out")["parameters/albedo"], np.float32(0.25)
    )
