"""Parameters recovered from images of scenes, with only the effects they call for."""

import dataclasses

import numpy as np
import pytest

import brdffit
from brdffit.effects import plan
from brdffit.models import MODELS
from brdffit.render import Noise, simulate_image, trace
from brdffit.scene import (
    Ambient,
    Directional,
    Environment,
    HeightMap,
    Mesh,
    Orthographic,
    Point,
    Scene,
    Sphere,
)

TRUTH = MODELS["ggx"](diffuse=[0.35, 0.15, 0.08], f0=[0.12, 0.1, 0.06], alpha=0.3)
NOISE = Noise(relative=0.01, seed=4)
CAMERA = Orthographic(40)
GREY = MODELS["lambert"]()
SUN = Directional([-0.48, 0.6, 0.64], np.pi)
LIGHTS = [[-0.48, 0.6, 0.64], [0.8, 0.0, 0.6], [0.0, -0.8, 0.6]]
BLIND = Mesh(
    ([[-9, -9, 0], [0, -9, 0], [0, 9, 0], [-9, 9, 0]], [[0, 1, 2], [0, 2, 3]]),
    position=[-1.2, 0, 1.4],
    material=GREY,
)
V, U = (np.mgrid[0:64, 0:128] + 0.5) / [[[64]], [[128]]]
DENTS = HeightMap(np.sin(16 * np.pi * U) * np.sin(9 * np.pi * V), scale=0.02)
SCENES = {
    "three directional lights": Scene(
        CAMERA, (Sphere(),), [Directional(d, np.pi) for d in LIGHTS]
    ),
    "a point light": Scene(CAMERA, (Sphere(),), (Point([-1.0, 1.2, 2.0], 16.0),)),
    "a shadow that crosses the sphere": Scene(CAMERA, (Sphere(), BLIND), (SUN,)),
    "a bumpy sphere": Scene(CAMERA, (Sphere(height=DENTS),), (SUN,)),
    "ambient light": Scene(CAMERA, (Sphere(),), (SUN, Ambient([0.3, 0.4, 0.5]))),
}
NEEDED = {
    "three directional lights": set(),
    "a point light": {"falloff"},
    "a shadow that crosses the sphere": {"shadows"},
    "a bumpy sphere": {"bump"},
    "ambient light": {"ambient"},
}


def fitted(samples):
    return brdffit.fit("ggx", samples, starts=4)


def deviations(result):
    """Distances from the truth in standard errors, for all that is determined."""
    found = []
    for name in ("diffuse", "f0", "alpha"):
        away = np.asarray(result.parameters[name]) - np.asarray(getattr(TRUTH, name))
        found.extend(np.atleast_1d(away / result.standard_errors[name]))
    return np.abs(found)


@pytest.mark.parametrize("name", SCENES)
def test_parameters_are_recovered_through(name):
    scene = SCENES[name]
    made = plan(scene)
    on = {effect for effect in made.decisions if made.on(effect)} - {"tangents"}
    assert on == NEEDED[name]
    result = fitted(simulate_image(TRUTH, scene, NOISE))
    assert result.converged
    assert deviations(result).max() < 4
    assert result.parameters["alpha"] == pytest.approx(0.3, rel=0.02)
    np.testing.assert_allclose(result.parameters["diffuse"], TRUTH.diffuse, rtol=0.02)


@pytest.mark.parametrize(
    ("name", "effect"),
    [
        ("a point light", "falloff"),
        ("a shadow that crosses the sphere", "shadows"),
        ("a bumpy sphere", "bump"),
        ("ambient light", "ambient"),
    ],
)
def test_an_effect_that_matters_is_missed_by_the_parameters(name, effect):
    """The image has it, the samples do not: the fit is wrong by many errors."""
    scene = SCENES[name]
    image = simulate_image(TRUTH, scene, NOISE)
    bare = trace(scene, plan(scene, without=[effect]))
    seen = dataclasses.replace(
        bare,
        value=image.value,
        sigma=image.sigma + 1e-6,
        mask=(bare.weight > 0).any(axis=1),
    )
    assert deviations(fitted(seen)).max() > 20


def test_what_the_plan_leaves_out_is_not_missed():
    """A light so far that falloff changes less than the noise."""
    far = Scene(CAMERA, (Sphere(),), (Point([-480.0, 600.0, 640.0], np.pi * 1e6),))
    made = plan(far, tolerance=2e-3)
    assert not made.on("falloff")
    image = simulate_image(TRUTH, far, NOISE, plan=plan(far, with_=["falloff"]))
    seen = dataclasses.replace(
        trace(far, made), value=image.value, sigma=image.sigma, mask=image.mask
    )
    assert deviations(fitted(seen)).max() < 4


def test_parameters_are_recovered_through_a_light_probe():
    """Fitted with the directions of a plan, fewer than the image was seen by.

    The tolerance is below the noise of a pixel; one of 0.01, as large as the noise, is
    met by 64 directions and leaves errors of the parameters of a third.
    """
    phi, y = 2 * np.pi * U, np.cos(np.pi * V)
    z = -np.sin(np.pi * V) * np.cos(phi)
    sun = 40 * np.exp(60 * (0.6 * y + 0.8 * z - 1))
    sky = (1 + y)[..., None] * [0.2, 0.3, 0.5] + sun[..., None] * [1.0, 0.9, 0.7]
    scene = Scene(Orthographic(20), (Sphere(),), (Environment(sky),))
    exact = plan(scene, TRUTH, tolerance=3e-4)
    image = simulate_image(TRUTH, scene, NOISE, plan=exact)
    few = plan(scene, TRUTH, tolerance=3e-3)
    assert few.directions < exact.directions
    seen = dataclasses.replace(
        trace(scene, few), value=image.value, sigma=image.sigma, mask=image.mask
    )
    result = fitted(seen)
    np.testing.assert_allclose(result.parameters["diffuse"], TRUTH.diffuse, rtol=0.03)
    np.testing.assert_allclose(result.parameters["f0"], TRUTH.f0, rtol=0.05)
    assert result.parameters["alpha"] == pytest.approx(0.3, rel=0.03)


def test_pixels_that_show_other_materials_are_left_out():
    ball, other = Sphere([-0.5, 0, 0], 0.5), Sphere([0.5, 0, 0], 0.5, material=GREY)
    samples = trace(Scene(CAMERA, (ball, other), (SUN,)))
    assert len(samples) == len(trace(Scene(CAMERA, (ball,), (SUN,))))
    assert (samples.pixels.column < 20).all()
