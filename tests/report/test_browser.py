"""Reports in a headless Chromium, as a reader meets them."""

import itertools

import pytest
from selenium.webdriver.common.keys import Keys

from tests.report.browser import DESK, PHONE

PAGES = ("compared", "photographed", "hostile")
CONTRAST = 4.5  # WCAG 2.1, level AA, for text

# texts that are cut off, or reach beyond the page; without those read aloud only
OVERFLOWING = """
const wide = document.documentElement.clientWidth, found = [];
for (const part of document.querySelectorAll("body, body *")) {
  const own = [...part.childNodes].some((n) => n.nodeType === 3 && n.data.trim());
  const box = part.getBoundingClientRect();
  if (!own || !box.width || part.closest(".hidden, .skip, thead, script, noscript"))
    continue;
  const cut = part.clientWidth && part.scrollWidth > part.clientWidth + 1;
  if (cut || box.left < -1 || box.right > wide + 1) found.push(part.outerHTML);
}
if (document.documentElement.scrollWidth > wide) found.push("the page");
return found;
"""

# texts whose contrast to what lies behind them is too low
FAINT = """
const canvas = document.createElement("canvas")
  .getContext("2d", {willReadFrequently: true});
const pixel = (colour) => {
  canvas.clearRect(0, 0, 1, 1);
  canvas.fillStyle = colour;
  canvas.fillRect(0, 0, 1, 1);
  return canvas.getImageData(0, 0, 1, 1).data;
};
const light = (colour) => {
  const [r, g, b] = [...pixel(colour)].map((value) => {
    const share = value / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const behind = (part) => {
  for (; part; part = part.parentElement) {
    const colour = getComputedStyle(part).backgroundColor;
    if (pixel(colour)[3] === 255) return colour;
  }
};
const found = [];
for (const part of document.querySelectorAll("body *")) {
  const own = [...part.childNodes].some((n) => n.nodeType === 3 && n.data.trim());
  if (!own || !part.getClientRects().length || part.closest("script, noscript"))
    continue;
  const style = getComputedStyle(part);
  const colour = part.namespaceURI.endsWith("svg") ? style.fill : style.color;
  const [a, b] = [light(colour), light(behind(part))];
  const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  if (ratio < %s) found.push(`${ratio.toFixed(2)} ${part.outerHTML}`);
}
return found;
"""


@pytest.fixture
def html(request):
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("html", PAGES, indirect=True)
def test_page_loads_without_a_word_on_the_console_or_a_request(browser, html):
    browser.show(html)
    asked = browser.requests()
    assert [url for url in asked if not url.startswith("data:")] == [
        url for url in asked if url.endswith("/page.html")
    ]
    assert len([url for url in asked if url.startswith("file:")]) == 1
    assert browser.console() == []


@pytest.mark.parametrize("width", [PHONE, DESK])
@pytest.mark.parametrize("html", PAGES, indirect=True)
def test_no_text_overflows(browser, html, width):
    browser.show(html, width)
    assert browser.run(OVERFLOWING) == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("html", PAGES, indirect=True)
def test_all_text_stands_out_from_what_lies_behind(browser, html, scheme):
    browser.show(html, scheme=scheme)
    assert browser.run(FAINT % CONTRAST) == []


def test_dark_mode_is_dark(browser, compared):
    ground = "return getComputedStyle(document.documentElement).backgroundColor"
    seen = {}
    for scheme in ("light", "dark"):
        browser.show(compared, scheme=scheme)
        seen[scheme] = [int(part) for part in browser.run(ground)[4:-1].split(",")]
    assert min(seen["light"]) > 240
    assert max(seen["dark"]) < 40


def test_wiping_uncovers_one_sphere_and_covers_the_other(browser, photographed):
    browser.show(photographed)
    clips = "return ['left', 'right'].map((id) => "
    clips += "getComputedStyle(document.getElementById(id)).clipPath)"
    assert browser.run(clips) == ["inset(0px 50% 0px 0px)", "inset(0px 0px 0px 50%)"]
    browser.press("wiper", *[Keys.ARROW_LEFT] * 20)
    assert browser.run(clips) == ["inset(0px 70% 0px 0px)", "inset(0px 0px 0px 30%)"]
    box = "const box = document.getElementById('left').getBoundingClientRect();"
    names = "return [...document.querySelectorAll('#left-name, #right-name')]"
    assert browser.run(f"{box} return Math.round(box.width - box.height)") == 0
    assert browser.run(f"{names}.map((n) => n.textContent)") == ["measured", "phong"]


def test_the_chosen_model_is_shown_everywhere(browser, photographed):
    browser.show(photographed)
    parts = "return [...document.querySelectorAll('section[data-model]')]"
    parts += ".filter((p) => !p.hidden).map((p) => p.dataset.model)"
    picture = (
        "return ['right', 'difference'].map((id) => document.getElementById(id).src)"
    )
    chosen = "return document.querySelector('#legend .chosen th').textContent"
    before = browser.run(picture)
    assert set(browser.run(parts)) == {"phong"}
    assert browser.run(chosen) == "phong"
    browser.choose("model", "lambert")
    assert set(browser.run(parts)) == {"lambert"}
    assert browser.run(chosen) == "lambert"
    assert all(a != b for a, b in zip(before, browser.run(picture), strict=True))


def test_lobes_follow_angle_channel_scale_and_model(browser, compared):
    browser.show(compared)
    curves = "return [...document.querySelectorAll('#chart path')]"
    curves += ".map((path) => path.getAttribute('d'))"
    drawn = [browser.run(curves)]
    for element, value in (("plane", "1"), ("channel", "0")):
        browser.choose(element, value)
        drawn.append(browser.run(curves))
    browser.press("logarithmic", Keys.SPACE)
    drawn.append(browser.run(curves))
    for before, after in itertools.pairwise(drawn):
        assert len(after) == 3
        assert before != after
    browser.run("document.querySelector('#legend input').click()")
    assert len(browser.run(curves)) == 2


def test_values_are_read_by_keyboard_and_by_pointer(browser, compared):
    browser.show(compared)
    read = "return [...document.querySelectorAll('#legend tr')]"
    read += ".map((row) => row.children[1].textContent)"
    at = "return document.getElementById('cursor-value').textContent"
    assert browser.run(at) == "20°"  # the mirror direction
    measured, phong, _, lambert = map(float, browser.run(read))
    truth = 0.2 / 3.14159 + 0.3 * 22 / (2 * 3.14159)  # diffuse and specular peak
    assert measured == phong == pytest.approx(truth, rel=5e-3)
    assert lambert == pytest.approx(0.3 / 3.14159, rel=5e-3)
    browser.press("cursor", Keys.ARROW_LEFT)
    assert browser.run(at) == "19.5°"
    browser.run(
        "const chart = document.querySelector('#chart svg');"
        "const box = chart.getBoundingClientRect();"
        "chart.dispatchEvent(new PointerEvent('pointermove',"
        "{clientX: box.left + 60, clientY: box.top + 50, bubbles: true}))"
    )
    assert browser.run(at).startswith("\N{MINUS SIGN}89")
    assert float(browser.run(read)[1]) < phong


def test_markup_in_names_stays_text(browser, hostile):
    browser.show(hostile)
    assert browser.run("return document.querySelectorAll('[onclick]').length") == 0
    name = browser.run("return document.querySelector('h1').textContent")
    assert name.startswith("<b onclick=")
    options = "return document.querySelector('#channel option').textContent"
    assert browser.run(options) == name


def test_paper_shows_three_spheres_and_no_controls(browser, photographed):
    browser.show(photographed)
    browser.media("print")
    shown = "return [...document.querySelectorAll('.spheres figure')]"
    shown += ".filter((f) => f.getClientRects().length).map((f) => f.innerText.trim())"
    words = browser.run(shown)
    assert [each.split("\n")[0] for each in words] == [
        "measured",
        "phong",
        "phong \N{MINUS SIGN} measured",
    ]
    controls = "return [...document.querySelectorAll('select, input')]"
    controls += ".filter((c) => c.getClientRects().length).length"
    assert browser.run(controls) == 0
