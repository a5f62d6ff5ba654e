import dataclasses

import numpy as np
import pytest

from brdffit import MODELS, render
from brdffit.render import render_texture
from brdffit.scene import Orthographic, Scene, Sphere
from tests import wall


def test_equal_texels_look_like_one_material_under_each_light_alone():
    scene = wall.scene((6, 8), lights=4)
    given = {
        "diffuse": np.broadcast_to([0.4, 0.2, 0.1], (6, 8, 3)),
        "alpha": np.full((6, 8, 1), 0.25),
    }
    found = render_texture("ggx", given, scene)
    brdf = MODELS["ggx"](diffuse=[0.4, 0.2, 0.1], alpha=0.25)
    assert found.shape == (4, 6, 8, 3)
    for image, light in zip(found, scene.lights, strict=True):
        alone = dataclasses.replace(scene, lights=(light,))
        np.testing.assert_allclose(image, render(brdf, alone), rtol=1e-5)


def test_each_texel_has_its_own_parameters():
    scene, maps = wall.scene((6, 8), lights=2), wall.maps((6, 8))
    found = render_texture("ggx", maps, scene)
    for row, column in [(0, 0), (5, 2), (3, 4)]:
        own = {name: image[row, column] for name, image in maps.items()}
        brdf = MODELS["ggx"](own["diffuse"], own["f0"], own["alpha"][0])
        alone = dataclasses.replace(scene, lights=scene.lights[:1])
        wanted = render(brdf, alone)[row, column]
        np.testing.assert_allclose(found[0, row, column], wanted, rtol=1e-5)


def test_pixels_beside_the_surface_are_black_and_one_channel_serves_for_all():
    scene = Scene(Orthographic(8), (Sphere(),), wall.scene(lights=2).lights)
    grey = {"albedo": np.full((8, 8, 1), 0.5)}
    found = render_texture(MODELS["lambert"](), grey, scene)
    assert found.shape == (2, 8, 8, 3)
    assert not found[:, 0, 0].any()
    assert found[:, 4, 4].all()


@pytest.mark.parametrize(
    ("maps", "sentence"),
    [
        ({"alpha": np.ones((6, 7, 1))}, "`alpha` must have shape .6, 8, 1., .*6, 7, 1"),
        ({"alpha": np.ones((6, 8, 3))}, "`alpha` must have shape .6, 8, 1."),
        ({"alhpa": np.ones((6, 8, 1))}, "Parameter `alhpa`.*`alpha`"),
    ],
)
def test_a_map_that_does_not_fit_is_one_sentence(maps, sentence):
    with pytest.raises(ValueError, match=sentence):
        render_texture(MODELS["ggx"](), maps, wall.scene((6, 8), lights=2))
