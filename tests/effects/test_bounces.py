import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.effects import plan
from brdffit.models import MODELS
from brdffit.render import materials_of, radiance, render, trace_paths
from brdffit.scene import (
    Directional,
    Environment,
    Glass,
    Mirror,
    Orthographic,
    Perspective,
    Plane,
    Scene,
    Sphere,
)

GREY = MODELS["lambert"](albedo=[0.5])
EVEN = Environment(np.ones((4, 8, 1)))
SUN = Directional([0.6, 0.8, 0.0], np.pi)
CAMERA = Orthographic(16)


def test_glass_and_mirrors_in_even_light_are_not_seen():
    """All light comes from somewhere: what is not reflected is refracted."""
    for material in (Glass(1.5), Glass(1 / 1.5), Mirror()):
        scene = Scene(CAMERA, (Sphere(radius=0.9, material=material),), (EVEN,))
        image = render(GREY, scene)
        np.testing.assert_allclose(image, 1, atol=0.02)


def test_a_metal_shows_its_fresnel_reflectance():
    metal = Mirror(eta=0.2, k=3.0)
    scene = Scene(Orthographic(1), (Plane(normal=[0, 0, 1], material=metal),), (EVEN,))
    expected = (0.8**2 + 9) / (1.2**2 + 9)
    np.testing.assert_allclose(render(GREY, scene), expected, rtol=1e-6)


def test_a_mirror_shows_what_is_in_front_of_it():
    """A floor seen in a wall is as bright as the floor itself, shadow and all."""
    half = 2**-0.5
    wall = Plane([1.0, 0, 0], [-1, 0, 0], material=Mirror(specular=0.5))
    floor = Plane([0, -1, 0])
    camera = Orthographic(1, towards=[-half, half, 0], target=[1.0, 0, 0])
    image = render(GREY, Scene(camera, (wall, floor), (Directional([-0.6, 0.8, 0]),)))
    np.testing.assert_allclose(image, 0.5 * 0.8 * 0.5 / np.pi, rtol=1e-5)


def test_a_ray_through_the_middle_of_glass_splits_as_fresnel_says():
    """Reflected 4 %; through both sides 0.96^2 / (1 - 0.04^2) of what is behind."""
    pixels = np.zeros((64, 128, 1))
    pixels[:, :32], pixels[:, 96:] = 1.0, 1.0  # behind, towards -z
    lens = Sphere(material=Glass(1.5))
    scene = Scene(Orthographic(1), (lens,), (Environment(pixels),), depth=8)
    expected = 0.96**2 / (1 - 0.04**2)
    np.testing.assert_allclose(render(GREY, scene), expected, rtol=1e-3)


@pytest.mark.parametrize(("depth", "seen"), [(2, 0.0), (3, 1.0)])
def test_the_depth_is_the_number_of_bounces(depth, seen):
    """Between two mirrors face to face, a ray meets them thrice, then a ball."""
    mirrors = (
        Plane([0, -1, 0], [0, 1, 0], material=Mirror()),
        Plane([0, 1, 0], [0, -1, 0], material=Mirror()),
    )
    ball = Sphere([6.0, 0, 0], 0.5, material=GREY)
    camera = Perspective(1, position=[0, 0, 0], target=[1.0, 1.0, 0])
    scene = Scene(camera, (*mirrors, ball), (Directional([-1, 0, 0]),), depth=depth)
    image = render(GREY, scene, plan(scene, GREY, without=["shadows"]))
    assert bool(image[0, 0, 0] > 0) == bool(seen)


def test_bounces_are_differentiable_in_every_material():
    """Against differences, with the directions of rays held as they were traced."""
    ball = Sphere([-0.45, 0, 0], 0.5, material=Glass(1.5))
    metal = Sphere([0.55, 0, 0], 0.5, material=Mirror(eta=[0.5], k=[2.0]))
    floor = Plane([0, -0.6, 0], material=MODELS["ggx"](f0=[0.3], alpha=0.4))
    scene = Scene(CAMERA, (ball, metal, floor), (SUN, EVEN), depth=3)
    traced = trace_paths(scene, plan(scene, GREY, tolerance=0.2), 1)
    materials = dict(materials_of(scene, GREY))

    @eqx.filter_jit
    def brightness(materials):
        return jnp.sum(radiance(materials, traced))

    slopes = eqx.filter_jit(eqx.filter_grad(brightness))(materials)
    for pick, step in (
        (lambda m: m[0].eta, 1e-3),
        (lambda m: m[1].k, 1e-2),
        (lambda m: m[2].alpha, 1e-2),
        (lambda m: m[2].f0, 1e-2),
    ):
        up, down = (
            brightness(eqx.tree_at(pick, materials, pick(materials) + sign * step))
            for sign in (1, -1)
        )
        difference = float((up - down) / (2 * step))
        assert abs(difference) > 0.1
        assert float(jnp.sum(pick(slopes))) == pytest.approx(difference, rel=0.02)


def test_the_image_of_paths_is_the_render():
    ball = Sphere(radius=0.6, material=Glass(1.5))
    scene = Scene(CAMERA, (ball, Plane([0, -0.7, 0])), (SUN,))
    made = plan(scene, GREY)
    traced = trace_paths(scene, made, 1)
    flat = jax.jit(lambda m: radiance(m, traced))(dict(materials_of(scene, GREY)))
    image = render(GREY, scene, made)
    np.testing.assert_allclose(image.reshape(-1, 1), flat, rtol=1e-5, atol=1e-6)
