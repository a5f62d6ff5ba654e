"""The overview in a browser: it sorts, fits a phone, and asks for nothing else."""

import pytest

from brdffit.batch import Tally
from brdffit.batch.folder import FITS, THUMBNAIL
from brdffit.batch.overview import write_overview
from tests.report.browser import DESK, PHONE
from tests.report.conftest import browser  # noqa: F401

ROWS = "[...document.querySelectorAll('tbody tr')]"
ORDER = f"return {ROWS}.map(row => row.cells[2].innerText)"
SORT = 'document.querySelectorAll("th button")[{column}].click(); ' + ORDER
PLAIN = {"converged": True, "residual": "log", "explained": 0.9, "at_bound": ""}
PLAIN |= {"undetermined": "", "failure": "", "seconds": 1.0}


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Three fits, one of which failed in words that look like HTML."""
    folder = tmp_path_factory.mktemp("out")
    rows = []
    for model, rms, above in (("phong", 0.03, 5.0), ("ggx", 0.2, 0.0)):
        row = {"file": "x" * 80 + ".csv", "model": model, "path": "/data/x.csv"}
        rows.append(row | PLAIN | {"rms": rms, "aicc_above_best": above})
        home = folder / FITS / row["file"] / model
        home.mkdir(parents=True)
        (home / THUMBNAIL).write_bytes(b"\x89PNG")
    failed = {"file": "b.csv", "model": "lambert", "path": "/data/b.csv"}
    rows.insert(1, failed | {"failure": "<b>Empty</b>. Nothing can be done."})
    return write_overview(folder, rows, Tally("fits", 3)).read_text()


def test_a_click_sorts_and_a_second_one_turns_the_order(browser, page):  # noqa: F811
    browser.show(page, DESK)
    assert browser.run(ORDER) == ["phong", "lambert", "ggx"]
    rms, model = 2, 1
    assert browser.run(SORT.format(column=rms)) == ["phong", "ggx", "lambert"]
    assert browser.run(SORT.format(column=rms)) == ["ggx", "phong", "lambert"]
    assert browser.run(SORT.format(column=model)) == ["ggx", "lambert", "phong"]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_a_phone_and_asks_for_nothing(browser, page, scheme):  # noqa: F811
    browser.show(page, PHONE, scheme)
    assert browser.run("return document.documentElement.scrollWidth") <= PHONE
    background = browser.run("return getComputedStyle(document.body).backgroundColor")
    assert (background == "rgb(255, 255, 255)") == (scheme == "light")
    assert all(url.startswith(("file:", "data:")) for url in browser.requests())
    assert browser.console() == []
    assert "&lt;b&gt;Empty&lt;/b&gt;" in page
