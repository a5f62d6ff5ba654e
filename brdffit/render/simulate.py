"""Measurements that were never made: known truth, known noise, known seed."""

import dataclasses
from typing import Any

import numpy as np

from brdffit.models.base import AbstractBRDF
from brdffit.parameters import registry_name, values
from brdffit.render.geometry_pass import trace
from brdffit.render.noise import NOISELESS, Noise
from brdffit.render.shading import channels, compiled_shade
from brdffit.samples import Measurement, Samples, as_samples, default_channels
from brdffit.scene import Goniometer, Scene


def simulate_image(
    brdf: AbstractBRDF, scene: Scene, noise: Noise = NOISELESS
) -> Samples:
    """Samples of an image of a scene, with values, standard deviations and mask.

    The mask is False where no light reaches, and where relative noise makes a value of
    zero certain: neither says anything about the BRDF.

    Raises:
        ValueError: The lights have another number of channels than the BRDF.
    """
    samples = trace(scene, channels(brdf))
    value, sigma = noise(compiled_shade(brdf, samples))
    lit = np.asarray(samples.weight).any(axis=1)
    return dataclasses.replace(
        samples,
        value=value,
        sigma=sigma,
        mask=lit if sigma is None else lit & (sigma > 0),
        name=registry_name(brdf),
    )


def simulate_measurement(
    brdf: AbstractBRDF, goniometer: Goniometer, noise: Noise = NOISELESS
) -> Measurement:
    """What a goniometer would read off a surface with this BRDF.

    The mask is False where relative noise makes a value of zero certain.
    """
    wi, wo = goniometer.directions()
    count = channels(brdf)
    unlit = np.zeros((len(wi), count), np.float32)
    truth = compiled_shade(brdf, as_samples(Measurement(wi=wi, wo=wo, f_r=unlit)))
    f_r, sigma = noise(truth)
    return Measurement(
        wi=wi,
        wo=wo,
        f_r=f_r,
        sigma=sigma,
        mask=None if sigma is None else sigma > 0,
        channels=default_channels(count),
        name=registry_name(brdf),
    )


def provenance(brdf: AbstractBRDF, noise: Noise = NOISELESS) -> dict[str, Any]:
    """The truth behind a simulation, for the file that stands beside it.

    Parameters are as short as their precision allows.
    """
    return {
        "model": registry_name(brdf),
        "parameters": {
            name: np.asarray(value).astype(str).astype(float).tolist()
            for name, value in values(brdf).items()
        },
        "noise": {
            "relative": noise.relative,
            "additive": noise.additive,
            "seed": noise.seed,
        },
    }
