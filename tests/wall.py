"""A textured wall of known parameters, photographed under one light after another."""

import numpy as np

from brdffit import images
from brdffit.render import render_texture
from brdffit.scene import Directional, Perspective, Plane, Point, Scene, save_scene

SHAPE = (10, 12)
LIGHTS = 8


def scene(shape=SHAPE, lights=LIGHTS):
    """A plane before a near camera; every fourth light is far away."""
    turn = np.arange(lights) * np.pi * (3 - np.sqrt(5))
    away = 1.5 * np.sqrt((np.arange(lights) + 0.5) / lights)
    place = np.stack([away * np.cos(turn), away * np.sin(turn), 0 * away + 1.6], axis=1)
    far = place / np.linalg.norm(place, axis=1, keepdims=True)
    return Scene(
        Perspective(shape, position=[0, 0, 2.8]),
        (Plane(normal=[0, 0, 1]),),
        [
            Directional(far[i], 1.2) if i % 4 == 3 else Point(place[i], 4.0)
            for i in range(lights)
        ],
    )


def maps(shape=SHAPE):
    """Colour and roughness that vary from texel to texel."""
    y, x = (np.indices(shape) + 0.5) / np.reshape(shape, (2, 1, 1))
    stripe = np.where(np.sin(9 * x) > 0, 0.4, 0.15)
    return {
        "diffuse": np.stack([stripe, 0.1 + 0.2 * y, 0.05 + 0.3 * x], axis=-1),
        "f0": np.full((*shape, 3), 0.05),
        "alpha": np.where(np.hypot(x - 0.5, y - 0.5) < 0.3, 0.4, 0.2)[..., None],
    }


def photograph(folder, shape=SHAPE, lights=LIGHTS, suffix=".exr", noise=0.0):
    """Write the photographs and their scene; returns the true maps."""
    folder.mkdir(exist_ok=True)
    truth, view = maps(shape), scene(shape, lights)
    rng = np.random.default_rng(0)
    for number, image in enumerate(render_texture("ggx", truth, view)):
        image *= 1 + noise * rng.standard_normal(image.shape, np.float32)
        images.write(folder / f"{number:02}{suffix}", image)
    save_scene(view, folder / "scene.toml")
    return truth
