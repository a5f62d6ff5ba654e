import hashlib

import pytest

import brdffit
from brdffit.databases import CHECKSUMS, DATABASES
from tests.readers import specimens
from tests.server import serving

ADDRESS = "/brdfs/gold-paint.binary"
FILE = "gold-paint.binary"


@pytest.fixture(scope="module")
def content(tmp_path_factory):
    """The beginning of a MERL file, which is all that a download looks at."""
    path = specimens.merl(tmp_path_factory.mktemp("merl"))
    return path.read_bytes()[:1_000_000]


@pytest.fixture
def server(content):
    with serving() as server:
        server.files[ADDRESS] = content
        yield server


@pytest.fixture
def fetch(server, tmp_path):
    def fetch(material="merl:gold-paint", **options):
        options = {"url": f"{server.url}brdfs"} | options
        return brdffit.fetch(material, tmp_path / "data", **options)

    return fetch


def visible(tmp_path):
    folder = tmp_path / "data"
    return sorted(p.name for p in folder.iterdir() if not p.name.startswith("."))


def test_a_file_is_fetched_once_with_progress(fetch, server, content, tmp_path):
    seen = []
    path = fetch(progress=lambda done, total: seen.append((done, total)))
    assert path.read_bytes() == content
    assert seen[-1] == (len(content), len(content))
    assert fetch() == path
    assert server.requests == 1
    assert visible(tmp_path) == [CHECKSUMS, FILE]
    assert len(list((tmp_path / "data").iterdir())) == 2, "no part is left"


def test_an_interrupted_download_goes_on_where_it_stopped(
    fetch, server, content, tmp_path
):
    server.stop_after = 400_000
    with pytest.raises(OSError, match=r"stopped half-way.*run this again to go on"):
        fetch()
    assert visible(tmp_path) == [], "no half file"
    server.stop_after = None
    assert fetch().read_bytes() == content
    (start,) = server.ranges
    assert 0 < start <= 400_000


def test_parts_of_two_versions_are_never_joined(fetch, server, content):
    server.stop_after = 400_000
    with pytest.raises(OSError, match="half-way"):
        fetch()
    newer = content[:-8] + b"changed!"
    server.files[ADDRESS], server.version, server.stop_after = newer, '"2"', None
    assert fetch().read_bytes() == newer
    assert server.ranges == []


def test_the_first_checksum_must_stay(fetch, server, content, tmp_path):
    path = fetch()
    listing = path.with_name(CHECKSUMS).read_text()
    assert listing == f"{hashlib.sha256(content).hexdigest()}  {FILE}\n"
    path.unlink()
    server.files[ADDRESS] = content[:-8] + b"changed!"
    with pytest.raises(ValueError, match="has another checksum than checksums.txt"):
        fetch()
    assert visible(tmp_path) == [CHECKSUMS]


def test_a_damaged_file_is_fetched_again(fetch, content):
    path = fetch()
    path.write_bytes(b"damaged")
    assert fetch().read_bytes() == content


def test_a_checksum_that_is_given_decides(fetch, content, tmp_path):
    with pytest.raises(ValueError, match="has another checksum than was given"):
        fetch(checksum="0" * 64)
    assert visible(tmp_path) == []
    right = hashlib.sha256(content).hexdigest().upper()
    assert fetch(checksum=f"sha256:{right}").is_file()


def test_a_material_that_is_not_there_is_one_sentence(fetch, tmp_path):
    with pytest.raises(OSError, match=r"There is no http://127.*names are listed at"):
        fetch("merl:gold-pant")
    assert visible(tmp_path) == []


def test_no_network_is_one_sentence(fetch, server, tmp_path):
    away = server.url
    server.shutdown()
    server.server_close()
    with pytest.raises(OSError, match=r"cannot be reached.*check the network"):
        fetch(url=away)
    assert visible(tmp_path) == []


def test_a_page_instead_of_a_file_is_refused(fetch, server, tmp_path):
    server.files[ADDRESS] = b"<html>moved</html>"
    with pytest.raises(ValueError, match="did not send a file of MERL binary"):
        fetch()
    assert list((tmp_path / "data").iterdir()) == []


def test_rgl_lies_in_folders_of_its_own(server, tmp_path):
    (tmp_path / "made").mkdir()
    made = specimens.rgl(tmp_path / "made")
    server.files["/paper/paper_rgb.bsdf"] = made.read_bytes()
    path = brdffit.fetch("rgl:paper", tmp_path, url=server.url)
    assert path.name == "paper_rgb.bsdf"
    assert len(brdffit.load(path)) > 0


@pytest.mark.parametrize(
    ("material", "reason"),
    [
        ("mrel:gold-paint", "Did you mean `merl`"),
        ("merl:", "must be `merl:` and a name"),
        ("merl:../gold", "must be `merl:` and a name"),
        ("rgl:.hidden", "must be `rgl:` and a name"),
        ("gold-paint", "Database `gold-paint` must be one of merl, rgl"),
    ],
)
def test_a_wrong_name_is_one_sentence(material, reason, tmp_path):
    with pytest.raises(ValueError, match=reason):
        brdffit.fetch(material, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_the_databases_are_those_of_their_papers():
    assert DATABASES["merl"].file.format("gold") == "gold.binary"
    assert DATABASES["rgl"].file.format("paper") == "paper/paper_rgb.bsdf"
    assert all(known.url.endswith("/") for known in DATABASES.values())
