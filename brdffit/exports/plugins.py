"""Models as plugins of Mitsuba 3: what `mitsuba.load_dict` takes."""

from typing import Any

import numpy as np

from brdffit.exports.material import plain
from brdffit.parameters import registry_name

Plugin = dict[str, Any]


def lambert(brdf: Any) -> Plugin:
    """A diffuse surface."""
    return {"type": "diffuse", "reflectance": rgb(brdf.albedo)}


def rgb(value: Any) -> Plugin:
    """A colour, as Mitsuba reads it."""
    return {"type": "rgb", "value": plain(value)}


def conductor(brdf: Any) -> Plugin:
    """Rough metal."""
    return {
        "type": "roughconductor",
        "distribution": registry_name(brdf).rpartition("_")[2],
        "alpha": plain(brdf.alpha),
        "eta": rgb(brdf.eta),
        "k": rgb(brdf.k),
        "specular_reflectance": rgb(brdf.specular),
    }


def glass(brdf: Any) -> Plugin:
    """Rough glass."""
    return {
        "type": "roughdielectric",
        "distribution": registry_name(brdf).rpartition("_")[2],
        "alpha": plain(brdf.alpha),
        "int_ior": plain(brdf.eta),
        "ext_ior": 1.0,
        "specular_reflectance": rgb(brdf.specular),
    }


def plastic(brdf: Any) -> Plugin:
    """A base under a coat, with light sent back to it from inside."""
    return {
        "type": "roughplastic",
        "distribution": "ggx",
        "alpha": plain(brdf.alpha),
        "int_ior": plain(brdf.eta),
        "ext_ior": 1.0,
        "nonlinear": True,
        "diffuse_reflectance": rgb(brdf.diffuse),
    }


def principled(brdf: Any) -> Plugin:
    """Disney's model."""
    plugin: Plugin = {"type": "principled", "base_color": rgb(brdf.base)}
    names = ("metallic", "roughness", "specular", "sheen", "clearcoat")
    plugin |= {name: plain(getattr(brdf, name)) for name in names}
    return plugin | {"clearcoat_gloss": plain(brdf.clearcoat_gloss)}


def lobe(f0: Any, alpha: Any) -> Plugin:
    """A GGX lobe with Schlick's factor alone, which is a metal of `principled`."""
    return {
        "type": "principled",
        "base_color": rgb(f0),
        "metallic": 1.0,
        "roughness": plain(np.sqrt(np.asarray(alpha))),
    }


def share(base: Any, f0: Any) -> float:
    """Weight of the gloss in a blend: as large as leaves the base its albedo."""
    base, f0 = np.asarray(base), np.asarray(f0)
    return float(np.clip(1 - base.max(), max(f0.max(), 1e-3), 1))


def blend(base: Any, f0: Any, alpha: Any) -> Plugin:
    """A diffuse base and a gloss side by side, each brightened for its weight."""
    weight = share(base, f0)
    bright = np.clip(np.asarray(base) / max(1 - weight, 1e-6), 0, 1)
    diffuse = {"type": "diffuse", "reflectance": rgb(bright)}
    glossy = lobe(np.asarray(f0) / weight, alpha)
    both = {"base": diffuse, "gloss": glossy}
    return {"type": "blendbsdf", "weight": plain(weight), **both}


DIRECT = {
    "lambert": lambert,
    "conductor_ggx": conductor,
    "conductor_beckmann": conductor,
    "dielectric_ggx": glass,
    "dielectric_beckmann": glass,
    "plastic_ggx": plastic,
    "principled": principled,
    "ggx_lobe": lambda brdf: lobe(brdf.f0, brdf.alpha),
}
"""Models that Mitsuba has, with what makes a plugin of each."""
