"""Everything is fitted with everything, once, and a failure is a row."""

import csv
import shutil

import pytest
from pyarrow import parquet

import brdffit
from brdffit.batch.folder import content_of, names_of

MODELS = ("lambert", "oren_nayar")


@pytest.fixture(scope="module")
def finished(tables, tmp_path_factory):
    """A finished run over two tables and a file that is none."""
    folder = tmp_path_factory.mktemp("batch")
    (folder / "notes.csv").write_text("nothing measured\n")
    files = [tables / "chalk.csv", folder / "notes.csv", tables / "slate.csv"]
    seen = []
    done = brdffit.batch(
        files, MODELS, folder / "out", starts=2, on_progress=lambda t: seen.append(t)
    )
    assert len(seen) == 6
    return files, done


@pytest.fixture
def copy(finished, tmp_path):
    """That run, in a folder of its own."""
    files, done = finished
    shutil.copytree(done.folder, tmp_path / "out")
    return files, tmp_path / "out"


def resume(copy, **options):
    files, folder = copy
    settings = {"starts": 2, "resume": True} | options
    return brdffit.batch(files, MODELS, folder, **settings)


def test_every_file_and_model_has_a_row_and_a_folder(finished):
    _, done = finished
    rows = {(row["file"], row["model"]): row for row in done.rows}
    assert list(rows) == [
        (f"{name}.csv", model)
        for name in ("chalk", "notes", "slate")
        for model in MODELS
    ]
    for name, albedo in (("chalk", 0.6), ("slate", 0.1)):
        row = rows[f"{name}.csv", "lambert"]
        assert row["converged"]
        assert row["albedo"] == pytest.approx(albedo, abs=4 * row["albedo_error"])
        home = done.folder / "fits" / f"{name}.csv" / "lambert"
        assert brdffit.load_result(home / "result.json").rms["log"] == row["rms"]
        assert (home / "thumbnail.png").read_bytes().startswith(b"\x89PNG")
        both = [rows[f"{name}.csv", model]["aicc_above_best"] for model in MODELS]
        assert min(both) == 0 < max(both)


def test_a_file_that_fails_is_a_row_with_its_sentence(finished):
    _, done = finished
    failed = [row for row in done.rows if row["failure"]]
    assert [row["file"] for row in failed] == ["notes.csv"] * 2
    assert all(
        "not a measurement that brdffit can read" in r["failure"] for r in failed
    )
    assert done.tally.failed == 2
    assert done.tally.done == 6


def test_the_table_says_the_same_as_csv_and_as_parquet(finished):
    _, done = finished
    with (done.folder / "results.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    typed = parquet.read_table(done.folder / "results.parquet").to_pylist()
    assert len(rows) == len(typed) == 6
    for row, same, own in zip(rows, typed, done.rows, strict=True):
        assert row["model"] == same["model"]
        assert (row["rms"] and float(row["rms"])) == own.get("rms", "")
        assert same["rms"] == own.get("rms")


def test_what_is_finished_is_kept_and_what_failed_is_tried_again(copy):
    before = {p: p.stat().st_mtime_ns for p in copy[1].rglob("result.json")}
    done = resume(copy)
    assert (done.tally.kept, done.tally.done, done.tally.failed) == (4, 2, 2)
    assert {p: p.stat().st_mtime_ns for p in copy[1].rglob("result.json")} == before


def test_a_spoiled_result_is_found_by_its_checksum_and_done_again(copy):
    path = copy[1] / "fits" / "slate.csv" / "lambert" / "result.json"
    whole = path.read_text()
    path.write_text(whole.replace("0.1", "0.2", 1))
    done = resume(copy)
    assert (done.tally.kept, done.tally.done) == (3, 3)
    result = brdffit.load_result(path)
    again = [row["albedo"] for row in done.rows if row["file"] == "slate.csv"][0]
    assert result.parameters["albedo"] == pytest.approx(0.1, rel=0.05)
    assert again == result.parameters["albedo"][0]


def test_other_content_or_options_are_done_again(copy, tmp_path, tables):
    files, folder = copy
    changed = tmp_path / "chalk.csv"
    shutil.copy(tables / "slate.csv", changed)  # under the name of the other
    done = brdffit.batch([changed], MODELS, folder, starts=2, resume=True)
    assert (done.tally.kept, done.tally.done) == (0, 2)
    assert done.rows[0]["albedo"] == pytest.approx(0.1, rel=0.05)
    done = brdffit.batch(
        [changed], MODELS[:1], folder, starts=2, residual="plain", resume=True
    )
    assert (done.tally.kept, done.tally.done) == (0, 1)
    assert done.rows[0]["residual"] == "plain"


def test_a_model_more_is_all_that_is_done(tables, tmp_path):
    run = {"files": [tables / "chalk.csv"], "out": tmp_path / "out", "starts": 2}
    brdffit.batch(models=MODELS[:1], **run)
    done = brdffit.batch(models=MODELS, **run, resume=True)
    assert (done.tally.kept, done.tally.done) == (1, 1)


def test_options_of_reading_are_those_of_load(tables, tmp_path):
    done = brdffit.batch(
        [tables / "chalk.csv"], ["lambert"], tmp_path / "out", starts=1, samples=20
    )
    assert done.rows[0]["count"] == 20


def test_bad_words_are_refused_before_anything_is_written(tables, tmp_path):
    files, out = [tables / "chalk.csv"], tmp_path / "out"
    with pytest.raises(ValueError, match="Did you mean `lambert`"):
        brdffit.batch(files, ["lamberd"], out)
    with pytest.raises(ValueError, match="Residual"):
        brdffit.batch(files, MODELS, out, residual="logg")
    with pytest.raises(ValueError, match="at least one file"):
        brdffit.batch([], MODELS, out)
    assert not out.exists()


def test_files_of_one_name_are_told_apart_by_their_folders():
    files = ["/data/a/scan.csv", "/data/b/scan.csv", "/data/b/scan.csv"]
    assert list(names_of(files)) == ["a_scan.csv", "b_scan.csv"]
    assert list(names_of(["/data/a/scan.csv", "/other/x.csv"])) == ["scan.csv", "x.csv"]


def test_content_is_that_of_the_scene_beside_an_image_and_of_all_in_a_folder(tmp_path):
    folder = tmp_path / "stack"
    folder.mkdir()
    image, scene = folder / "ball.exr", folder / "ball.toml"
    image.write_bytes(b"pixels")
    found = {content_of(image), content_of(folder)}
    scene.write_text("[camera]")
    found |= {content_of(image), content_of(folder)}
    scene.write_text("[lights]")
    found |= {content_of(image), content_of(folder)}
    assert len(found) == 6


def test_the_overview_stands_alone(finished):
    _, done = finished
    page = (done.folder / "index.html").read_text()
    assert page.count("data:image/png;base64,") == 4
    assert page.count("<tr>") == 1 + 6
    assert "not a measurement" in page
    assert "http" not in page.replace("http-equiv", "")
