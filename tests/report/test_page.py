"""What stands in a report, read as HTML."""

import dataclasses
import json
import re
from html.parser import HTMLParser

import jax
import numpy as np
import pytest

import brdffit
from brdffit import MODELS
from brdffit.report.page import page
from tests.report.conftest import HOSTILE, PHONG
from tests.results import result_of

PAGES = ("compared", "photographed", "hostile")
LINKS = ("src", "srcset", "href", "action", "data", "poster")
SVG = "http://www.w3.org/2000/svg"  # the name of its elements, which nobody visits
LARGEST = 3_000_000  # bytes
BLOCKS = {"td", "th", "dt", "dd", "div", "li", "p", "h1", "h2", "h3", "code", "option"}
VOID = {"meta", "link", "img", "input", "wbr"}


class Parsed(HTMLParser):
    """Elements of a page with their attributes, and its text."""

    def __init__(self, html):
        super().__init__()
        self.elements, self.words, self.data, self.open = [], [], {}, []
        self.feed(html)
        self.text = " ".join("".join(self.words).split())

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        self.words.append(" " if tag in BLOCKS else "")
        if tag not in VOID:
            self.open.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag, f"</{tag}> closes another element"

    def handle_data(self, data):
        tag, attrs = self.open[-1] if self.open else ("", {})
        if tag == "script" and "id" in attrs:
            self.data[attrs["id"]] = json.loads(data)
        elif tag not in ("script", "style"):
            self.words.append(data)

    def all(self, *tags):
        return [attrs for tag, attrs in self.elements if tag in tags]


@pytest.fixture
def parsed(request):
    return Parsed(request.getfixturevalue(request.param))


every_page = pytest.mark.parametrize("parsed", PAGES, indirect=True)


@every_page
def test_every_element_is_closed(parsed):
    assert parsed.open == []


@every_page
def test_headings_come_in_order_below_one_title(parsed):
    levels = [int(tag[1]) for tag, _ in parsed.elements if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    steps = zip(levels, levels[1:], strict=False)
    assert all(after <= before + 1 for before, after in steps)


@every_page
def test_every_picture_says_what_it_shows(parsed):
    pictures = parsed.all("img")
    assert len(pictures) > 4
    assert all(len(each["alt"]) > 10 for each in pictures)
    assert all(each["src"].startswith("data:image/webp;") for each in pictures)


@every_page
def test_every_control_has_a_label(parsed):
    labelled = {attrs.get("for") for attrs in parsed.all("label")}
    controls = parsed.all("select", "input")
    assert controls
    for control in controls:
        inside = control["id"] == "logarithmic"  # its label is around it
        assert control["id"] in labelled or control.get("aria-label") or inside


@every_page
def test_every_name_inside_the_page_is_there_once(parsed):
    names = [attrs["id"] for _, attrs in parsed.elements if "id" in attrs]
    assert len(names) == len(set(names))
    for _, attrs in parsed.elements:
        wanted = (attrs.get("aria-labelledby"), attrs.get("for"))
        assert {name for name in wanted if name} <= set(names)


@pytest.mark.parametrize("name", PAGES)
def test_nothing_is_fetched_from_elsewhere(request, name):
    html = request.getfixturevalue(name)
    policy = next(m for m in Parsed(html).all("meta") if "http-equiv" in m)
    assert policy["content"].startswith("default-src 'none'; img-src data:;")
    parts = [attrs for _, attrs in Parsed(html).elements]
    links = [attrs[name] for attrs in parts for name in LINKS if name in attrs]
    assert links
    assert all(link.startswith(("data:", "#")) for link in links)
    assert set(re.findall(r"https?://[^\"\s]*", html)) == {SVG}
    assert len(html) < LARGEST


def test_verdict_says_who_wins_and_by_how_much(compared):
    text = Parsed(compared).text
    assert "phong fits best" in text.replace("\n", " ")
    assert "On 20 directions that no fit had seen, phong is off by 11" in text
    assert "The next model is phong (2), off by 22" in text
    assert "2.0 times as much" in text
    assert "The fit of lambert did not converge" in text


def test_every_parameter_stands_with_its_error_and_its_doubts(compared):
    text = Parsed(compared).text
    assert "kd diffuse[0] R 0.300 ± 0.010 [0, 1]" in text
    assert "p exponent 20.000 ± 0.010 [0, 100000]" in text
    assert "albedo[0] has no effect on these data." in text
    assert "ρ albedo[0] R 0.4 [0, 1] not determined" in text
    assert "albedo[2] B 0.200 ± 0.010 [0, 1] at its bound" in text
    assert "diffuse[0] R and specular[0] R, \N{MINUS SIGN}0.95" in text


def test_how_it_was_found_and_made_is_told(compared):
    text = Parsed(compared).text
    assert "16 of 16 ended in the best minimum" in text
    assert "Minima met 1" in text
    assert "54 pairs of directions" in text
    assert "20° to 50° from the normal" in text
    assert "0.25" not in text
    assert "brdffit 0." in text
    assert "jax 0." in text


def test_strings_are_escaped(hostile):
    parsed = Parsed(hostile)
    assert not any("onclick" in attrs for _, attrs in parsed.elements)
    assert "{{ 7 * 7 }}" in parsed.text
    assert parsed.text.count("dust") > 3
    assert parsed.data["lobes-data"]["channels"][0] == HOSTILE
    assert "</script>'" not in hostile


def test_numbers_of_the_lobes_are_those_of_the_data(compared, goniometer):
    lobes = Parsed(compared).data["lobes-data"]
    assert lobes["channels"] == ["R", "G", "B"]
    first = lobes["planes"][0]
    assert first["mirror"] == pytest.approx(20)
    assert set(map(float, first["measured"][0])) <= {
        float(f"{value:.4g}") for value in goniometer.f_r[:, 0]
    }
    assert list(first["models"]) == ["phong", "phong (2)", "lambert"]


def test_data_that_show_no_lobes_have_no_chart():
    lights = ((0, 0, 1), (0.6, 0, 0.8))
    image = brdffit.simulate_image(PHONG, brdffit.lit_sphere(24, lights))
    text = Parsed(page(result_of(PHONG, "cosine_weighted"), image)).text
    assert "Lobes" not in text
    assert "measured" in text


def test_a_single_fit_says_how_far_off_it_is(goniometer):
    result = result_of(PHONG, masked=20, agreement=0.125, basins=3)
    parsed = Parsed(page(result, goniometer))
    assert "phong is off by 13" in parsed.text
    assert "The model explains 90 % of the variation" in parsed.text
    assert "Only 2 of 16 starts ended in the best minimum" in parsed.text
    assert "20 of 120 values (17 %) were left out" in parsed.text
    assert "Ranking" not in parsed.text
    assert "show no sphere" in parsed.text


def test_spectral_data_have_a_picture_of_their_correlations():
    truth = MODELS["ggx"](diffuse=[0.2] * 8, f0=[0.05] * 8, alpha=0.3)
    names = tuple(f"{length} nm" for length in range(400, 720, 40))
    instrument = brdffit.Goniometer([30], range(0, 81, 20), [0, 180])
    data = brdffit.simulate_measurement(truth, instrument)
    data = dataclasses.replace(data, channels=names)
    parsed = Parsed(page(result_of(truth, channels=names), data))
    assert any("correlations of 17" in each["alt"] for each in parsed.all("img"))
    assert parsed.data["lobes-data"]["channels"] == ["400 nm", "560 nm", "680 nm"]


def test_a_known_material_is_shown_as_a_sphere(goniometer):
    def evaluate(wi, wo):
        return np.asarray(jax.vmap(PHONG)(wi, wo), float)

    spheres = Parsed(page(result_of(PHONG), goniometer, None, evaluate)).data
    frame = spheres["spheres-data"]["frames"][0]
    assert set(frame["pictures"]) == {"measured", "phong"}
    assert frame["pictures"]["measured"] == frame["pictures"]["phong"]
    assert spheres["spheres-data"]["against"] == {"phong": "measured"}


def test_the_file_is_whole_or_absent(tmp_path, goniometer):
    path = brdffit.report(result_of(PHONG), goniometer, tmp_path / "report.html")
    assert path.read_text(encoding="utf-8").startswith("<!doctype html>")
    with pytest.raises(OSError, match="is not a folder"):
        brdffit.report(result_of(PHONG), goniometer, tmp_path / "no" / "report.html")
    assert [each.name for each in tmp_path.iterdir()] == ["report.html"]
