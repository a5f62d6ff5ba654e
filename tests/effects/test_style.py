import numpy as np
import pytest

from brdffit.effects import plan
from brdffit.models import MODELS
from brdffit.render import render, trace
from brdffit.scene import (
    Directional,
    Gooch,
    Mesh,
    Orthographic,
    Plane,
    Point,
    Scene,
    Sphere,
)

RED = MODELS["lambert"](albedo=[0.8, 0.1, 0.1])
SIDE = Directional([1.0, 0.0, 0.0])


BALL = Sphere()


def picture(style, shapes=(BALL,), light=SIDE, resolution=65):
    return render(RED, Scene(Orthographic(resolution), shapes, (light,), style=style))


def test_the_side_that_faces_the_light_is_warm_and_the_other_cool():
    image = picture(Gooch(outlines=False))
    warm, cool = np.add([0.3, 0.3, 0], 0.5 * np.array([0.8, 0.1, 0.1])), [0.2, 0.025, 0]
    x = (2 * 63 + 1) / 65 - 1
    cool = np.add([0, 0, 0.55], 0.25 * np.array([0.8, 0.1, 0.1]))
    for column, c in ((63, x), (1, -x), (32, 0.0)):
        expected = cool * (1 - c) / 2 + warm * (1 + c) / 2
        np.testing.assert_allclose(image[32, column], expected, rtol=1e-5)


@pytest.mark.parametrize("steps", [1, 3, 6])
def test_tones_are_as_many_as_the_steps(steps):
    image = picture(Gooch(steps=steps, outlines=False))
    colours = np.unique(image.reshape(-1, 3).round(5), axis=0)
    assert len(colours) == steps + 1  # and the background


def test_an_outline_runs_around_the_shape_and_nowhere_else():
    image = picture(Gooch())
    y, x = np.mgrid[0:65, 0:65]
    inside = np.hypot(x - 32, y - 32) < 32.5
    padded = np.pad(inside, 1, mode="edge")
    around = [padded[1:-1, :-2], padded[1:-1, 2:], padded[:-2, 1:-1], padded[2:, 1:-1]]
    rim = inside & ~np.all(around, axis=0)
    black = (image == 0).all(axis=-1)
    np.testing.assert_array_equal(black & inside, rim)


def test_an_outline_lies_on_the_nearer_of_two_shapes_and_along_creases():
    image = picture(Gooch(), (Sphere(radius=0.5), Plane([0, 0, -1], [0, 0, 1])))
    y, x = np.mgrid[0:65, 0:65]
    radius = np.hypot(x - 32, y - 32) / 32.5
    black = (image == 0).all(axis=-1)
    assert black.any()
    assert ((radius > 0.4) & (radius < 0.5))[black].all()
    roof = Mesh(
        (
            [[-2, -2, 0], [0, -2, 1], [0, 2, 1], [-2, 2, 0], [2, -2, 0], [2, 2, 0]],
            [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]],
        )
    )
    steep = Mesh((roof.file.vertices * [1, 1, 4], roof.file.faces))
    black = (picture(Gooch(), (steep,)) == 0).all(axis=-1)
    np.testing.assert_array_equal(np.flatnonzero(black.any(axis=0)), [32])


def test_a_highlight_lies_between_viewer_and_light():
    light = Point([3.0, 0.0, 400.0])
    with_it = picture(Gooch(highlight=1.0, outlines=False), light=light)
    without = picture(Gooch(outlines=False), light=light)
    difference = (with_it - without)[..., 0]
    assert np.unravel_index(difference.argmax(), difference.shape) == (32, 32)
    assert difference.max() == pytest.approx(1, rel=1e-3)


def test_a_picture_in_a_style_is_no_measurement():
    scene = Scene(Orthographic(4), (Sphere(),), (SIDE,), style=Gooch())
    with pytest.raises(ValueError, match="shows no reflectance: take `style` out"):
        trace(scene)
    assert len(trace(scene, plan(scene, without=["style"]))) == 12


def test_a_style_needs_a_light_with_a_place_or_a_direction():
    from brdffit.scene import Ambient

    with pytest.raises(ValueError, match="`style` needs a directional light"):
        Scene(Orthographic(4), (Sphere(),), (Ambient(1.0),), style=Gooch())


def test_colours_must_fit_the_channels_of_the_image():
    sentence = "`cool` of `style` must be one number or 3, one for each channel, but h"
    with pytest.raises(ValueError, match=sentence):
        picture(Gooch(cool=[0.0, 0.5]))
