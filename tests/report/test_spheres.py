import base64
import io

import numpy as np
import pytest
from matplotlib.image import imread

import brdffit
from brdffit import MODELS
from brdffit.report.spheres import sphere_album

GREY = MODELS["lambert"](albedo=[0.5])
DARK = MODELS["lambert"](albedo=[0.25])


def pixels(uri):
    content = base64.b64decode(uri.removeprefix("data:image/webp;base64,"))
    shown = np.asarray(imread(io.BytesIO(content), format="webp"), int)
    opaque = np.full((*shown.shape[:2], 1), 255)  # where the file leaves it out
    return np.concatenate([shown, opaque], axis=2)[..., :4]


@pytest.fixture(scope="module")
def photograph():
    return brdffit.simulate_image(GREY, brdffit.lit_sphere(40))


def test_a_photograph_is_shown_beside_every_model(photograph):
    album = sphere_album(photograph, {"grey": GREY, "dark": DARK})
    (frame,) = album["frames"]
    assert album["against"] == {"grey": "measured", "dark": "measured"}
    shown = {name: pixels(uri) for name, uri in frame["pictures"].items()}
    assert shown["measured"].shape == (40, 40, 4)
    assert np.abs(shown["measured"] - shown["grey"]).max() <= 2
    assert shown["dark"][:, :, 0].mean() < 0.8 * shown["grey"][:, :, 0].mean()


def test_what_is_too_dark_is_blue_and_what_is_equal_pale(photograph):
    album = sphere_album(photograph, {"grey": GREY, "dark": DARK})
    equal, dark = (
        pixels(album["frames"][0]["differences"][name])[10, 14]
        for name in ("grey", "dark")
    )
    assert min(equal[:3]) > 230
    assert dark[2] > dark[0] + 50


def test_a_disc_is_continued_to_the_edge_where_the_page_cuts_it(photograph):
    album = sphere_album(photograph, {"grey": GREY})
    assert album["round"]
    assert np.all(pixels(album["frames"][0]["pictures"]["grey"])[..., 3] == 255)


def test_a_share_of_the_pixels_shows_no_gaps(photograph):
    some = photograph.take(np.arange(0, len(photograph), 3))
    seen = pixels(sphere_album(some, {"grey": GREY})["frames"][0]["pictures"]["grey"])
    assert np.all(seen[10:30, 10:30, 3] == 255)


def test_pixels_that_were_not_used_are_grey(photograph):
    mask = np.ones((len(photograph), 1), bool)
    mask[np.asarray(photograph.pixels.row) < 20] = False
    masked = brdffit.Samples(
        **{**vars(photograph), "mask": mask & np.asarray(photograph.mask)}
    )
    album = sphere_album(masked, {"grey": GREY})
    above, below = (
        pixels(album["frames"][0]["differences"]["grey"])[row, 14] for row in (10, 26)
    )
    assert max(abs(above[:3] - 0xB9)) < 12
    assert min(below[:3]) > 230


def test_without_any_measured_sphere_models_are_compared():
    data = brdffit.simulate_measurement(GREY, brdffit.Goniometer([30], [0, 30], [0]))
    album = sphere_album(data, {"a": GREY, "b": DARK, "c": DARK})
    assert album["against"] == {"a": "b", "b": "a", "c": "a"}
    alone = sphere_album(data, {"a": GREY})
    assert alone["against"] == alone["frames"][0]["differences"] == {}
