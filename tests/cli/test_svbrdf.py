import json

import numpy as np
import pytest

from brdffit import images
from tests import wall


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("photographs") / "wall"
    wall.photograph(path, (4, 6), lights=6, noise=0.01)
    return path


def test_maps_and_prediction_are_told_and_written(run, folder, tmp_path):
    words = ["svbrdf", folder, "--model", "lambert", "--hold-out", "2"]
    status, out, err = run(*words, "--out", tmp_path / "out")
    assert (status, err) == (0, "")
    assert "lambert fitted to 24 texels of wall, each seen in 5 photographs" in out
    assert "albedo[G]" in out
    assert "01.exr was held out; the maps predict it with a relative root mean" in out
    assert "albedo.exr, albedo_error.exr, rms.exr" in out
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"maps.png", "maps.pdf", "held_out.png", "held_out.exr"} <= names
    assert {"summary.json", "fit", "maps", "stack.zarr"} <= names
    for name in ("maps.png", "held_out.png"):
        assert (tmp_path / "out" / name).stat().st_size > 10_000


def test_json_says_the_same(run, folder, tmp_path):
    words = ["svbrdf", folder, "--model", "lambert", "--json"]
    status, out, _ = run(*words, "--out", tmp_path / "out")
    told = json.loads(out)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    files = told.pop("files")
    assert status == 0
    assert told == summary
    assert str(tmp_path / "out" / "maps" / "albedo.exr") in files


def test_texels_that_do_not_converge_are_told_by_the_status(run, tmp_path):
    dark = tmp_path / "dark"
    wall.photograph(dark, (4, 6), lights=6)
    for path in sorted(dark.glob("*.exr")):  # one number is left of each texel
        pixels = images.read(path).pixels
        pixels[..., (0 if path.stem > "00" else 1) :] = np.nan
        images.write(path, pixels)
    words = ["svbrdf", dark, "--model", "lambert", "--out", tmp_path / "out"]
    status, out, _ = run(*words)
    assert status == 1
    assert "24 did not converge" in out


def test_bad_input_is_one_sentence(run, folder, tmp_path):
    words = ["svbrdf", folder, "--model", "lambert", "--out", tmp_path / "out"]
    for more in (["--fix", "albedo"], ["--residual", "lgo"], ["--hold-out", "9"]):
        status, out, err = run(*words, *more)
        assert (status, out) == (2, ""), more
        assert err.count("\n") == 1
        assert err.endswith((".\n", "?\n"))
    assert run(*words)[0] == 0
    status, _, err = run(*words)
    assert status == 2
    assert "holds an earlier run: go on with it by --resume" in err
    assert run(*words, "--resume")[0] == 0
