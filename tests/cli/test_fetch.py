import json

from tests.readers import specimens
from tests.server import serving


def test_a_material_is_fetched_and_its_place_told(run, tmp_path):
    (tmp_path / "made").mkdir()
    content = specimens.rgl(tmp_path / "made").read_bytes()
    with serving() as server:
        server.files["/paper/paper_rgb.bsdf"] = content
        words = ("rgl:paper", "--out", tmp_path / "out", "--url", server.url)
        status, out, err = run("fetch", *words)
        assert (status, err) == (0, "")
        assert "rgl:paper is at" in out
        path = json.loads(run("fetch", *words, "--json")[1])["file"]
        assert path == str(tmp_path / "out" / "paper_rgb.bsdf")
        status, out, err = run("fetch", "rgl:papper", *words[1:])
    assert (status, out) == (2, "")
    assert err.startswith("brdffit: There is no http://127")
    assert err.count("\n") == 1
