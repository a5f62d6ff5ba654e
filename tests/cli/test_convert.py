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


def test_spectral_data_become_rgb_under_a_stated_light(run, tmp_path):
    bands = range(400, 701, 20)
    names = ",".join(f"{band} nm" for band in bands)
    header = "# brdffit table 1\n# angles: degrees\n# cosine: not included\n"
    row = "30,0,10,180," + ",".join("0.2" for _ in bands)
    path = tmp_path / "grey.csv"
    path.write_text(f"{header}theta_i,phi_i,theta_o,phi_o,{names}\n{row}\n")
    out = tmp_path / "rgb.csv"
    status, _, err = run("convert", path, out, "--illuminant", "A")
    assert (status, err) == (0, "")
    data = brdffit.load(out)
    assert data.channels == ("R", "G", "B")
    assert data.name == "grey under A"
    assert np.allclose(data.f_r, 0.2)
    facts = json.loads(run("info", path, "--illuminant", "D65", "--json")[1])
    assert facts["channels"] == ["R", "G", "B"]
    status, _, err = run("info", out, "--illuminant", "D65")
    assert status == 2
    assert "must have wavelengths for channels" in err
