"""Bad input: one clear sentence, exit status 2, nothing left behind."""

import shutil
from pathlib import Path

import pytest

import brdffit
from brdffit.writers import table
from tests.data import shared_data

SYNTHETIC = Path(__file__).parents[2] / "data_synthetic"


@pytest.fixture
def refuse(run, tmp_path):
    """Run a command that must be refused without a trace; returns its sentence."""

    def refuse(*words):
        before = sorted(tmp_path.rglob("*"))
        status, out, err = run(*words)
        assert (status, out) == (2, "")
        assert err.startswith("brdffit: ")
        assert err.count("\n") == 1, "one line"
        assert err.endswith((".\n", "?\n")), "a sentence"
        assert "Traceback" not in err
        assert sorted(tmp_path.rglob("*")) == before, "nothing left behind"
        return err

    return refuse


def cut(source, target, share=0.6):
    """The beginning of a file, as an interrupted copy leaves it."""
    content = source.read_bytes()
    target.write_bytes(content[: int(len(content) * share)])
    return target


def fit(data, tmp_path, *words):
    return ("fit", data, "--model", "lambert", "--out", tmp_path / "out", *words)


def test_missing_file(refuse, tmp_path):
    sentence = refuse(*fit(tmp_path / "missing.csv", tmp_path))
    assert "missing.csv` does not exist" in sentence


def test_empty_file(refuse, tmp_path):
    path = tmp_path / "empty.csv"
    path.touch()
    assert "is empty" in refuse(*fit(path, tmp_path))


def test_file_that_is_no_measurement(refuse, tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("buy milk\n")
    assert "is not a measurement that brdffit can read" in refuse(*fit(path, tmp_path))


def test_truncated_table(refuse, chalk, tmp_path):
    path = cut(chalk, tmp_path / "cut.csv")
    assert "cut.csv" in refuse(*fit(path, tmp_path))


@pytest.mark.parametrize("suffix", [".txt", ".bsdf"])
def test_truncated_fred_and_zemax(refuse, tmp_path, suffix):
    source = shared_data("ualoft", f"AnoBlackEC1onAlum{suffix}")
    path = cut(source, tmp_path / f"cut{suffix}")
    assert f"cut{suffix}" in refuse(*fit(path, tmp_path))


def test_truncated_exr(refuse, tmp_path):
    path = cut(SYNTHETIC / "phong_one_light.exr", tmp_path / "cut.exr")
    shutil.copy(SYNTHETIC / "phong_one_light.toml", tmp_path / "cut.toml")
    assert "is not a complete EXR file" in refuse(*fit(path, tmp_path))


@pytest.mark.parametrize("value", ["nan", "-0.25"])
def test_values_that_cannot_be_used(refuse, tmp_path, value):
    path = tmp_path / "broken.csv"
    rows = "".join(f"{angle},0,{angle},180,{value}\n" for angle in range(0, 80, 10))
    header = "# brdffit table 1\n# angles: degrees\n# cosine: not included\n"
    path.write_text(header + "theta_i,phi_i,theta_o,phi_o,f_r\n" + rows)
    sentence = refuse(*fit(path, tmp_path))
    assert "no value that can be used" in sentence


def test_some_values_that_cannot_be_used_are_left_out_and_counted(run, chalk, tmp_path):
    data = brdffit.load(chalk)
    f_r = data.f_r.copy()
    f_r[3], f_r[7] = float("nan"), -0.1
    path = tmp_path / "mixed.csv"
    table.save(brdffit.Measurement(data.wi, data.wo, f_r, name="mixed"), path)
    status, out, _ = run("fit", path, "--model", "lambert")
    assert status == 0
    assert "79 values, 2 left out" in out


def test_wrong_model_name_suggests_the_nearest(refuse, chalk, tmp_path):
    words = ("fit", chalk, "--out", tmp_path / "out", "--model")
    assert "Did you mean `oren_nayar`?" in refuse(*words, "orennayar")
    assert "Did you mean `ggx_lobe`?" in refuse(*words, "lambert+ggxlobe")
    compare = ("compare", chalk, "--models", "lambert,fong", "--out", tmp_path / "out")
    assert "Did you mean `phong`?" in refuse(*compare)


def test_wrong_residual_suggests_the_nearest(refuse, chalk, tmp_path):
    sentence = refuse(*fit(chalk, tmp_path, "--residual", "cosine-weighted"))
    assert "Did you mean `cosine_weighted`?" in sentence


@pytest.mark.parametrize(
    ("fixed", "reason"),
    [
        ("albedo=3", "`albedo` of `lambert` must lie in [0, 1], but is 3"),
        ("albedo=nan", "`albedo` of `lambert` must lie in [0, 1], but is nan"),
        ("albedo=0.1,0.2", "must be held at one number, but is given 2"),
        ("albedo=half", "must be given numbers"),
        ("albedo", "must be given name=value"),
        ("albdo=0.5", "Did you mean `albedo`?"),
    ],
)
def test_wrong_parameter_to_hold(refuse, chalk, tmp_path, fixed, reason):
    assert reason in refuse(*fit(chalk, tmp_path, "--fix", fixed))


def test_no_start_at_all(refuse, chalk, tmp_path):
    assert "`starts` must be 1 or above" in refuse(*fit(chalk, tmp_path, "--starts", 0))


def test_channel_that_is_not_there(refuse, chalk, tmp_path):
    sentence = refuse(*fit(chalk, tmp_path, "--channels", "Z"))
    assert "Channel `Z` must be one of" in sentence


def test_folder_that_cannot_be_written(refuse, chalk, tmp_path, monkeypatch):
    monkeypatch.setattr(brdffit, "fit", never_called)
    taken = tmp_path / "taken"
    taken.write_text("a file, not a folder")
    words = ("fit", chalk, "--model", "lambert", "--out")
    assert "is not a folder" in refuse(*words, taken / "out")
    assert "is not a folder" in refuse(*words, taken)


def never_called(*_arguments, **_options):
    raise AssertionError("the folder is looked at before the long work")


@pytest.mark.parametrize("option", ["--starts=many", "--modle=ggx", "--starts"])
def test_wrong_option(refuse, chalk, option):
    sentence = refuse("fit", chalk, "--model", "lambert", option)
    assert option.partition("=")[0] in sentence


def test_wrong_command(refuse):
    assert 'Did you mean "fit"' in refuse("fti")


def test_command_without_its_model(refuse, chalk):
    assert "--model" in refuse("fit", chalk)


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("--set alpha=3 --out x.csv", "`alpha` of `ggx` must lie in [0.0001, 1]"),
        ("--set alhpa=0.3 --out x.csv", "Did you mean `alpha`?"),
        ("--set alpha=0.3,0.4 --out x.csv", "must be one number, but 2 are given"),
        ("--set f0=1,1,1 diffuse=0,0 --out x.csv", "must be 1 or 3 numbers"),
        ("--out x.txt", "must end in .csv (table) or .exr (image)"),
        ("--lights 0 --out x.csv", "--lights says nothing about a .csv file"),
        ("--phi 0 --out x.exr", "--phi says nothing about a .exr file"),
        ("--lights 0 --out x.exr", "`--lights` must be a whole number, 1 or above"),
        ("--theta-i 95 --out x.csv", "must lie from 0 to below 90 degrees"),
        ("--noise -1 --out x.csv", "must be one number not below 0"),
        ("--scene missing.toml --out x.exr", "missing.toml` cannot be read"),
    ],
)
def test_simulation_of_what_cannot_be(refuse, tmp_path, monkeypatch, words, reason):
    monkeypatch.chdir(tmp_path)
    assert reason in refuse("simulate", "--model", "ggx", *words.split())


def test_rendering_of_what_cannot_be(refuse, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "missing.json` cannot be used" in refuse(
        "render", "missing.json", "--out", "x.exr"
    )
    Path("broken.json").write_text('{"model": "ggx"}')
    assert "must be a result saved by brdffit" in refuse(
        "render", "broken.json", "--out", "x.exr"
    )
    assert "must end in .exr" in refuse("render", "ggx", "--out", "x.png")


SCENE = """
camera = {kind = "orthographic", resolution = 8}
shapes = [{kind = "sphere"}]
lights = [{kind = "directional", direction = [0, 0, 1]}]
"""


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ('kind = "sphere"', 'kind = "sphere", radius = 0', "radius"),
        ('kind = "sphere"', 'kind = "plane", normal = [0, 0, 0]', "normal"),
        ('kind = "sphere"', 'kind = "mesh", file = "flat.obj"', "file"),
        ('kind = "sphere"', 'kind = "sphere", height = {map = "no.exr"}', "map"),
        ('"directional", direction', '"environment", map = "flat.obj", x', "x"),
        ("[0, 0, 1]", "[0, 0, 2]", "direction"),
        ("[0, 0, 1]", "[0, 0, nan]", "direction"),
        ("[0, 0, 1]", "[0, 0, 1], irradiance = -1", "irradiance"),
        ("= 8", "= 8, target = [0, 0, 1e300]", "target"),
        ("= 8", "= 1e9", "resolution"),
    ],
)
def test_scenes_that_cannot_be(refuse, tmp_path, old, new, key):
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    assert SCENE.count(old) == 1
    (tmp_path / "scene.toml").write_text(SCENE.replace(old, new))
    assert f"`{key}`" in refuse("plan", tmp_path / "scene.toml")
