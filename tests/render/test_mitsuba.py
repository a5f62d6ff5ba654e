"""The same spheres rendered by Mitsuba 3, an independent renderer.

Rays pass through pixel centres in both, masking is separable in both, and pixels on the
outline are left out.
"""

import numpy as np
import pytest

from brdffit.effects import plan
from brdffit.models import MODELS
from brdffit.render import render
from brdffit.scene import (
    Directional,
    Environment,
    Orthographic,
    Plane,
    Point,
    Scene,
    ShadowRays,
    Sphere,
)

mitsuba = pytest.importorskip("mitsuba")

SIZE = 32
BRDF = MODELS["conductor_ggx"](
    specular=1.0, alpha=0.3, eta=[0.2, 0.9, 1.1], k=[3.9, 2.4, 2.1], separable=True
)
ROUGH = {
    "type": "roughconductor",
    "distribution": "ggx",
    "alpha": 0.3,
    "eta": {"type": "rgb", "value": [0.2, 0.9, 1.1]},
    "k": {"type": "rgb", "value": [3.9, 2.4, 2.1]},
}
SKY = (64, 128)


@pytest.fixture(scope="module", autouse=True)
def _variant():
    mitsuba.set_variant("scalar_rgb")
    yield
    mitsuba.set_variant("scalar_rgb")


def theirs(light, samples=1, seed=0, integrator="direct", more=None):
    """The image of a unit sphere by Mitsuba, with the camera of `Orthographic`."""
    transform = mitsuba.ScalarTransform4f
    camera = transform().look_at(origin=[0, 0, 5], target=[0, 0, 0], up=[0, 1, 0])
    scene = mitsuba.load_dict(
        {
            "type": "scene",
            "integrator": {"type": integrator},
            "sensor": {
                "type": "orthographic",
                "to_world": camera @ transform().scale([1, 1, 1]),
                "film": {
                    "type": "hdrfilm",
                    "width": SIZE,
                    "height": SIZE,
                    "pixel_format": "rgb",
                    "component_format": "float32",
                    "rfilter": {"type": "box"},
                },
                "sampler": {"type": "independent", "sample_count": samples},
            },
            "ball": {"type": "sphere", "bsdf": ROUGH},
            "light": light,
        }
        | (more or {})
    )
    if samples > 1:
        return np.array(mitsuba.render(scene, seed=seed, spp=samples))
    return centres(scene)


def centres(scene):
    """One ray through the centre of each pixel, which no sampler of Mitsuba takes."""
    sensor, integrator = scene.sensors()[0], scene.integrator()
    sampler = sensor.sampler()
    image = np.zeros((SIZE, SIZE, 3))
    for row in range(SIZE):
        for column in range(SIZE):
            place = [(column + 0.5) / SIZE, (row + 0.5) / SIZE]
            ray, _ = sensor.sample_ray_differential(0.0, 0.5, place, [0.5, 0.5])
            colour, _, _ = integrator.sample(scene, sampler, ray)
            image[row, column] = colour
    return image


def compared(ours, other, margin=0.0):
    """Relative root mean square of the difference, pixels on the outline apart."""
    x = (2 * np.arange(SIZE) + 1) / SIZE - 1
    seen = x**2 + x[:, None] ** 2 < (1 - margin - 1.5 / SIZE) ** 2
    difference = (ours - other)[seen]
    return np.sqrt(np.mean(difference**2) / np.mean(other[seen] ** 2))


def test_a_directional_light_agrees():
    towards = np.array([-0.48, 0.6, 0.64])
    light = {
        "type": "directional",
        "direction": (-towards).tolist(),
        "irradiance": {"type": "rgb", "value": [1.0, 2.0, 3.0]},
    }
    scene = Scene(
        Orthographic(SIZE), (Sphere(),), (Directional(towards, [1.0, 2.0, 3.0]),)
    )
    assert compared(render(BRDF, scene), theirs(light)) < 1e-4


def test_a_point_light_agrees():
    light = {
        "type": "point",
        "position": [-1.0, 1.5, 2.0],
        "intensity": {"type": "rgb", "value": [3.0, 2.0, 1.0]},
    }
    scene = Scene(
        Orthographic(SIZE), (Sphere(),), (Point([-1, 1.5, 2], [3.0, 2.0, 1.0]),)
    )
    assert compared(render(BRDF, scene), theirs(light)) < 1e-4


def test_the_shadow_of_a_floor_agrees():
    """A sphere that half dives into a floor, under an oblique light, both visible."""
    towards = np.array([0.6, 0.8, 0.0])
    light = {
        "type": "directional",
        "direction": (-towards).tolist(),
        "irradiance": {"type": "rgb", "value": [1.0, 1.0, 1.0]},
    }
    transform = mitsuba.ScalarTransform4f
    tilted = np.array([0.0, 0.8, 0.6])
    floor = {
        "type": "rectangle",
        "to_world": transform().look_at(
            origin=[0, -0.5, 0],
            target=(np.array([0, -0.5, 0]) + tilted).tolist(),
            up=[1, 0, 0],
        )
        @ transform().scale([100, 100, 100]),
        "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse"}},
    }
    grey = MODELS["lambert"](albedo=[0.5] * 3)
    shapes = (Sphere(), Plane([0, -0.5, 0], tilted, material=grey))
    scene = Scene(
        Orthographic(SIZE), shapes, (Directional(towards),), shadows=ShadowRays()
    )
    ours, other = render(BRDF, scene), theirs(light, more={"floor": floor})
    apart = np.abs(ours - other).max(axis=-1) > 1e-3 * other.max()
    assert apart.mean() < 0.005  # pixels whose centre lies on an edge
    assert 0.05 < (other == 0).all(axis=-1).mean() < 0.5


def probe():
    """A sky with a sun, its rows as ours and as Mitsuba has them, from pole to pole."""

    def sky(v):
        v, u = np.meshgrid(v, (np.arange(SKY[1]) + 0.5) / SKY[1], indexing="ij")
        y, phi = np.cos(np.pi * v), 2 * np.pi * u
        x, z = np.sin(np.pi * v) * np.sin(phi), -np.sin(np.pi * v) * np.cos(phi)
        sun = 20 * np.exp(15 * (-0.48 * x + 0.6 * y + 0.64 * z - 1))
        return (1.2 + y)[..., None] * [0.2, 0.3, 0.5] + sun[..., None] * [1, 0.9, 0.7]

    rows = np.arange(SKY[0])
    return sky((rows + 0.5) / SKY[0]), sky(rows / (SKY[0] - 1))


def test_a_light_probe_agrees_within_the_noise():
    """The noise is that of pixels with 4,096 samples, from two images of theirs.

    The second one has a quarter of the samples, so twice the noise.
    """
    ours, other = probe()
    light = {
        "type": "envmap",
        "bitmap": mitsuba.Bitmap(other.astype(np.float32)),
    }
    first, second = (theirs(light, samples=n, seed=n) for n in (4096, 1024))
    noise = compared(second, first) / np.sqrt(5)
    scene = Scene(Orthographic(SIZE), (Sphere(),), (Environment(ours),))
    image = average_over_pixels(scene)
    assert 1e-4 < noise < 0.02
    assert compared(image, first) < 3 * noise


def average_over_pixels(scene, fine=2):
    """Box-filtered as theirs: the mean of rays spread over each pixel."""
    camera = Orthographic(SIZE * fine)
    scene = Scene(camera, scene.shapes, scene.lights)
    image = render(BRDF, scene, plan(scene, BRDF, tolerance=2e-3))
    return image.reshape(SIZE, fine, SIZE, fine, 3).mean(axis=(1, 3))
