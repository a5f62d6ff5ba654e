import json

import numpy as np

import brdffit


def test_a_table_is_converted(run, chalk, tmp_path):
    out = tmp_path / "new" / "copy.csv"
    status, text, err = run("convert", chalk, out)
    assert (status, err) == (0, "")
    assert "Written 81 pairs of directions as a table." in text
    assert np.array_equal(brdffit.load(out).f_r, brdffit.load(chalk).f_r)


def test_json_names_the_file(run, chalk, tmp_path):
    out = tmp_path / "copy.csv"
    assert json.loads(run("convert", chalk, out, "--json")[1])["file"] == str(out)


def test_what_cannot_be_converted_is_refused_in_a_sentence(run, chalk, tmp_path):
    status, out, err = run("convert", chalk, tmp_path / "x.binary")
    assert (status, out) == (2, "")
    assert "do not fill a grid or an image" in err
    assert not (tmp_path / "x.binary").exists()
