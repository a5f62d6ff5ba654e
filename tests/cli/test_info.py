import json

from tests.data import shared_data
from tests.readers import specimens


def test_info_says_what_a_file_holds(run, chalk):
    status, out, err = run("info", chalk)
    words = " ".join(out.split())
    assert (status, err) == (0, "")
    assert "chalk: brdffit table." in words
    assert "81 pairs of directions." in words
    assert "Polar angles of the light 10 to 70 degrees" in words
    assert "81 usable values; none is invalid." in words
    assert "Known is the error of every value." in words
    assert "channel lowest highest" in words
    assert "f_r [1/sr]" in words


def test_json_has_every_fact_and_out_a_picture(run, chalk, tmp_path):
    status, out, _ = run("info", chalk, "--json", "--out", tmp_path / "out")
    facts = json.loads(out)
    assert status == 0
    assert (facts["format"], facts["samples"]) == ("table", 81)
    assert facts["invalid"] == {}
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "coverage.png",
        "coverage.pdf",
    }


def test_merl_cannot_break_reciprocity_and_rgl_is_asked(run, tmp_path):
    _, out, _ = run("info", specimens.merl(tmp_path))
    assert "the format holds one value for both orders of a pair" in out
    assert "below the horizon" in out
    paper = shared_data("rgl", "paper_white_rgb.bsdf")
    found = json.loads(run("info", paper, "--json")[1])["reciprocity"]
    assert found["exact"]
    assert 0.001 < found["median"] < 0.03


def test_a_wrong_file_is_refused_in_a_sentence(run, tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("buy milk\n")
    status, out, err = run("info", path)
    assert (status, out) == (2, "")
    assert "is not a measurement that brdffit can read" in err
