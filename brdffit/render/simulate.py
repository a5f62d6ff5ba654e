"""Measurements that were never made: known truth, known noise, known seed."""

import dataclasses
from typing import Any

import numpy as np

from brdffit.catalogue import description as description
from brdffit.effects import Plan
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import registry_name
from brdffit.render.geometry_pass import trace
from brdffit.render.noise import NOISELESS, Noise
from brdffit.render.shading import compiled_shade
from brdffit.samples import Measurement, Samples, as_samples, default_channels
from brdffit.scene import Goniometer, Scene


def simulate_image(
    brdf: AbstractBRDF,
    scene: Scene,
    noise: Noise = NOISELESS,
    name: str = "",
    plan: Plan | None = None,
) -> Samples:
    """Samples of an image of a scene, with values, standard deviations and mask.

    Only pixels that see shapes without a material of their own are samples.

    The mask is False where no light reaches, and where relative noise makes a value of
    zero certain: neither says anything about the BRDF.

    Args:
        brdf: The truth.
        scene: Camera, shape and lights.
        noise: What is added to the truth.
        name: What is seen; by default the name of the model.
        plan: What to simulate; by default what the scene calls for.

    Raises:
        ValueError: The lights have another number of channels than the BRDF.
    """
    samples = trace(scene, plan, brdf.channels)
    value, sigma = noise(compiled_shade(brdf, samples))
    lit = np.asarray(samples.weight).any(axis=1)
    if samples.ambient is not None:
        lit |= np.asarray(samples.ambient) > 0
    return dataclasses.replace(
        samples,
        value=value,
        sigma=sigma,
        mask=lit if sigma is None else lit & (sigma > 0),
        name=name or registry_name(brdf),
    )


def simulate_measurement(
    brdf: AbstractBRDF,
    goniometer: Goniometer,
    noise: Noise = NOISELESS,
    name: str = "",
) -> Measurement:
    """What a goniometer would read off a surface with this BRDF.

    The mask is False where relative noise makes a value of zero certain.

    Args:
        brdf: The truth.
        goniometer: Which pairs of directions are measured.
        noise: What is added to the truth.
        name: What is measured; by default the name of the model.
    """
    wi, wo = goniometer.directions()
    setup = Measurement(
        wi=wi,
        wo=wo,
        f_r=np.full((len(wi), brdf.channels), np.nan, np.float32),
        channels=default_channels(brdf.channels),
        name=name or registry_name(brdf),
    )
    f_r, sigma = noise(compiled_shade(brdf, as_samples(setup)))
    mask = None if sigma is None else sigma > 0
    return dataclasses.replace(setup, f_r=f_r, sigma=sigma, mask=mask)


def provenance(brdf: AbstractBRDF, noise: Noise = NOISELESS) -> dict[str, Any]:
    """The truth behind a simulation, for the file that stands beside it."""
    return description(brdf) | {
        "noise": {
            "relative": noise.relative,
            "additive": noise.additive,
            "seed": noise.seed,
        }
    }
