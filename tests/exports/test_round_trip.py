"""From a BRDF to Mitsuba, through its images, and back to the parameters."""

import dataclasses
import xml.etree.ElementTree as ElementTree

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import brdffit
from brdffit import MODELS, images
from brdffit.microfacet import fresnel
from brdffit.render.shading import compiled_shade
from brdffit.scene import save_scene

mitsuba = pytest.importorskip("mitsuba")

FINER = 5  # pixels to a side of one, of which the middle one is kept
LOWEST = 0.25  # cosine of the steepest view that is kept; a pixel is wide there
LIGHTS = [(0.0, 0.28, 0.96), (0.6, -0.3, 0.742), (-0.85, 0.2, 0.487)]


def photograph(xml, light, resolution):
    """What Mitsuba sees of a sphere of the material in a file under one light."""
    mitsuba.set_variant("scalar_rgb")
    (element,) = ElementTree.parse(xml).getroot()
    element.set("version", "3.0.0")
    bsdf = mitsuba.load_string(ElementTree.tostring(element, encoding="unicode"))
    x, y, z = (-float(c) for c in light.direction)
    up = mitsuba.ScalarTransform4f
    film = {
        "type": "hdrfilm",
        "width": FINER * resolution,
        "height": FINER * resolution,
        "rfilter": {"type": "box"},
        "pixel_format": "rgb",
    }
    scene = mitsuba.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "direct", "bsdf_samples": 0, "emitter_samples": 1},
            "sensor": {
                "type": "orthographic",
                "to_world": up().look_at([0, 0, 3], [0, 0, 0], [0, 1, 0]),
                "film": film,
                "sampler": {"type": "independent", "sample_count": 1},
            },
            "sphere": {"type": "sphere", "bsdf": bsdf},
            "light": {
                "type": "directional",
                "direction": [x, y, z],
                "irradiance": {"type": "rgb", "value": [float(light.irradiance)] * 3},
            },
        }
    )
    image = np.array(mitsuba.render(scene, seed=1))
    return image[FINER // 2 :: FINER, FINER // 2 :: FINER]


@pytest.fixture
def there_and_back(tmp_path):
    """Export, photograph under each light, write as EXR, and read the folder."""

    def travel(brdf, resolution=64):
        brdffit.export(brdf, "mitsuba", tmp_path / "material.xml")
        folder = tmp_path / "images"
        folder.mkdir()
        centre = (2 * np.arange(resolution) + 1) / resolution - 1
        steep = 1 - centre**2 - centre[:, None] ** 2 < LOWEST**2
        for number, direction in enumerate(LIGHTS):
            towards = np.array(direction) / np.linalg.norm(direction)
            scene = brdffit.lit_sphere(resolution, [towards])
            (light,) = scene.lights
            pixels = photograph(tmp_path / "material.xml", light, resolution)
            pixels = pixels.astype(np.float32)
            lit = pixels.max(axis=-1) > 0
            pixels[steep | ~lit] = np.nan
            path = folder / f"{number}.exr"
            images.write(path, pixels)
            save_scene(scene, path.with_suffix(".toml"))
        return brdffit.load(folder)

    return travel


def shown(brdf, data):
    """Pixels of a BRDF where there are measured ones."""
    return np.asarray(compiled_shade(brdf, data))[data.mask]


def apart(a, b):
    """Root mean square of a difference over that of the second."""
    return np.sqrt(np.mean((a - b) ** 2) / np.mean(b**2))


def test_a_conductor_comes_back(there_and_back):
    """Of its index only the reflectance over the angles that were seen is certain."""
    truth = MODELS["conductor_ggx"](
        eta=[0.2, 0.6, 1.2], k=[3.9, 2.6, 2.0], alpha=0.3, separable=True
    )
    data = there_and_back(truth)
    start = dataclasses.replace(truth, alpha=0.5, eta=0.5 + 0 * truth.eta)
    fitted = brdffit.fit(start, data, starts=2, fixed={"specular": 1.0}, max_steps=40)
    assert fitted.parameters["alpha"] == pytest.approx(0.3, rel=0.01)
    steepest = np.degrees(np.arccos(np.sum(data.wi[:, 0] * data.wo, axis=1).min())) / 2
    cosines = jnp.cos(jnp.radians(jnp.linspace(0, steepest, 9)))
    reflectance = jax.vmap(fresnel.conductor, (0, None, None))
    there, back = (
        np.asarray(reflectance(cosines, b.eta, b.k)) for b in (truth, fitted.brdf)
    )
    assert np.allclose(back, there, rtol=0.01)
    assert apart(shown(fitted.brdf, data), shown(truth, data)) < 0.005


def test_a_plastic_comes_back(there_and_back):
    truth = MODELS["plastic_ggx"](
        diffuse=[0.5, 0.35, 0.2], alpha=0.05, eta=1.5, separable=True
    )
    data = there_and_back(truth, 80)
    fitted = brdffit.fit(dataclasses.replace(truth, alpha=0.2), data, starts=2)
    assert fitted.parameters["diffuse"] == pytest.approx([0.5, 0.35, 0.2], rel=0.01)
    assert fitted.parameters["alpha"] == pytest.approx(0.05, rel=0.01)
    assert fitted.parameters["eta"] == pytest.approx(1.5, rel=0.01)


def test_a_principled_comes_back(there_and_back):
    """On so much metal sheen and coat leave no trace, but in what is seen together."""
    truth = MODELS["principled"](
        base=[0.8, 0.5, 0.2], metallic=0.8, roughness=0.5, separable=True
    )
    data = there_and_back(truth)
    fitted = brdffit.fit(dataclasses.replace(truth, roughness=0.4), data, starts=2)
    assert fitted.parameters["base"] == pytest.approx([0.8, 0.5, 0.2], rel=0.01)
    assert fitted.parameters["metallic"] == pytest.approx(0.8, rel=0.01)
    assert fitted.parameters["roughness"] == pytest.approx(0.5, rel=0.01)
    assert apart(shown(fitted.brdf, data), shown(truth, data)) < 0.01
