"""What a scene does not call for leaves no operation in the compiled program."""

import re

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.models import MODELS
from brdffit.render import shade, trace
from brdffit.scene import Ambient, Directional, Orthographic, Point, Scene, Sphere
from brdffit.scene.nearest import _first

SUN = Directional([-0.48, 0.6, 0.64], np.pi)
MODELS_SEEN = ("lambert", "phong", "ggx", "conductor_ggx")


def scene(*lights, **more):
    return Scene(Orthographic(16), (Sphere(**more),), lights)


def bare(brdf, samples):
    """Shading as one would write it for a lone sphere, without a thought of effects."""

    def value(wi, wo, weight):
        return jnp.sum(jax.vmap(brdf, in_axes=(0, None))(wi, wo) * weight, axis=0)

    return jax.vmap(value)(samples.wi, samples.wo, samples.weight)


def program(function, *arguments):
    """The lowered text of a function under one name."""
    arrays, rest = eqx.partition(arguments, eqx.is_array)
    text = jax.jit(lambda arrays: function(*eqx.combine(arrays, rest))).lower(arrays)
    return re.sub(r"module @\S+", "module", text.as_text())


def kinds(text):
    return set(re.findall(r"(?:stablehlo|chlo|mhlo)\.\w+", text))


@pytest.mark.parametrize("name", MODELS_SEEN)
def test_a_lone_sphere_under_one_light_compiles_to_bare_shading(name):
    samples = trace(scene(SUN))
    text = program(shade, MODELS[name](), samples)
    assert text == program(bare, MODELS[name](), samples)
    for word in ("while", "gather", "erf", "case", "scatter", "sort", "custom_call"):
        assert not any(word in kind for kind in kinds(text)), word


def test_the_words_that_are_looked_for_are_those_of_the_text():
    """So that the test above can fail."""

    def loop(x):
        return jax.lax.while_loop(lambda x: x[0] < 3, lambda x: x + 1, x)

    assert "stablehlo.while" in kinds(program(loop, jnp.zeros(2)))
    assert any(
        "gather" in k for k in kinds(program(lambda x: x[x.astype(int)], SUN.direction))
    )


def test_an_effect_that_is_left_out_leaves_the_same_program():
    """A point light, an ambient light of no radiance, a height map without height."""
    plain = program(shade, MODELS["ggx"](), trace(scene(SUN)))
    for other in (scene(Point([0, 3, 4])), scene(SUN, Ambient(0.0))):
        assert program(shade, MODELS["ggx"](), trace(other)) == plain
    lit = trace(scene(SUN, Ambient(0.1)))
    assert program(shade, MODELS["ggx"](), lit) != plain


def test_tracing_a_lone_sphere_looks_for_no_other_shape():
    """One sphere: no choice between shapes, no loop, and no triangle."""
    camera = Orthographic(4)
    groups = {"Sphere": (np.zeros((1, 3)), np.ones(1))}
    two = {"Sphere": (np.zeros((2, 3)), np.ones(2))}
    origin, direction = camera.rays()
    rest = np.array(origin), np.array(direction), np.zeros(16)
    text = _first.lower(groups, *rest).as_text()
    assert not any("gather" in k or "while" in k for k in kinds(text))
    assert any("gather" in k for k in kinds(_first.lower(two, *rest).as_text()))
