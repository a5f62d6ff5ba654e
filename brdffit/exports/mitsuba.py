"""Mitsuba 3: a BSDF as XML, or as the dictionary that `mitsuba.load_dict` takes.

A model that Mitsuba has goes over as it is, but for what Mitsuba does otherwise: its
masking is separable, the base of its `roughplastic` is lit through the rough interface,
and its `principled` has the exact Fresnel factor of glass and a coat without the factor
1 / (4 cos_i cos_o). A diffuse base with a gloss becomes whichever comes nearer of a
blend, whose Fresnel factor ends below 1, and of a `principled`; any other model becomes
the nearest `principled`.

What is written is evaluated by Mitsuba itself.
"""

import dataclasses
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np

from brdffit.exports.deviation import deviation, hemisphere
from brdffit.exports.dressing import gloss
from brdffit.exports.match import ROUGHNESSES, colour, match
from brdffit.exports.material import Evaluate, Material, evaluator, in_rgb, plain
from brdffit.exports.plugins import DIRECT, Plugin, blend, rgb, share
from brdffit.files import replacing
from brdffit.microfacet import fresnel
from brdffit.models import AbstractBRDF
from brdffit.models.principled import diffuse
from brdffit.parameters import registry_name
from brdffit.types import Values, Vectors

DESCRIPTION = "Mitsuba 3 BSDF, as XML"
SUFFIX = ".xml"

VARIANT = "scalar_rgb"
BASE_PAIRS = 1000  # of directions on which bases of plastic are compared

BOUNDS = {
    "base_color": (0.0, 1.0),
    "metallic": (0.0, 1.0),
    "roughness": (0.0316, 1.0),
    "eta": (1.001, 4.0),
}
SEPARABLE = (
    "Masking in Mitsuba is separable, that of the fit height-correlated: this change "
    "alone makes an error of {}."
)
PLASTIC = (
    "The base of Mitsuba's roughplastic is lit and seen through the rough interface, "
    "that of plastic_ggx through a smooth one; its reflectance is changed so that both "
    "bases reflect the same on the whole."
)
GLASS = "Mitsuba's roughdielectric also lets light through, which f_r says nothing of."
DISNEY = (
    "Mitsuba's principled has the exact Fresnel factor of glass and a coat without "
    "1 / (4 cos_i cos_o)."
)
BLEND = "A blend's gloss reflects {:.2g} of the light towards grazing, the model's all."
NEAREST = "Mitsuba has no `{}`; the nearest principled is taken."


def translate(brdf: AbstractBRDF, channels: Sequence[str] = ()) -> Material:
    """The BSDF of Mitsuba that is, or comes nearest to, a BRDF.

    Raises:
        ValueError: It has more channels than colours, or is anisotropic.
    """
    brdf = in_rgb(brdf, "Mitsuba", channels)
    if not brdf.isotropic:
        raise ValueError(
            f"Model `{registry_name(brdf)}` cannot be exported to Mitsuba, because "
            f"brdffit writes isotropic materials for it only: export it to glsl."
        )
    truth = evaluator(brdf)
    options = [
        Material(
            evaluate=by_mitsuba(plugin),
            write=lambda path, plugin=plugin: write(plugin, path),
            parameters=plugin,
            evaluator="Mitsuba",
            notes=notes,
        )
        for plugin, notes in candidates(brdf)
    ]
    if len(options) == 1:
        return options[0]
    return min(options, key=lambda option: deviation(truth, option.evaluate).mean)


def candidates(brdf: Any) -> Iterator[tuple[Plugin, tuple[str, ...]]]:
    """What a BRDF may be told Mitsuba as, with sentences about what differs."""
    name = registry_name(brdf)
    if name in DIRECT:
        plugin = DIRECT[name](brdf)
        if name == "plastic_ggx":
            plugin = brightened(brdf, plugin)
        yield plugin, notes_of(brdf)
        return
    if name in ("ggx", "lambert+ggx_lobe"):
        parts = (
            (brdf.diffuse, brdf) if name == "ggx" else (brdf.first.albedo, brdf.second)
        )
        base, gloss = parts
        weight = share(base, gloss.f0)
        notes = (*notes_of(gloss), BLEND.format(weight))
        yield blend(base, gloss.f0, gloss.alpha), notes
    yield nearest(brdf), (NEAREST.format(name),)


def notes_of(brdf: Any) -> tuple[str, ...]:
    """Sentences about what Mitsuba does otherwise with a model that it has."""
    notes = []
    if getattr(brdf, "separable", True) is False:
        other = dataclasses.replace(brdf, separable=True)
        notes.append(SEPARABLE.format(deviation(evaluator(brdf), evaluator(other))))
    kind = registry_name(brdf)
    special = {
        "plastic_ggx": PLASTIC,
        "dielectric_ggx": GLASS,
        "dielectric_beckmann": GLASS,
        "principled": DISNEY,
    }
    if kind in special:
        notes.append(special[kind])
    return tuple(notes)


def brightened(brdf: Any, plugin: Plugin) -> Plugin:
    """A plastic whose base reflects on the whole what that of the model does.

    Base reflectances d enter both as d / (1 - d F_in).
    """
    wi, wo = hemisphere(np.random.default_rng(2), (2, BASE_PAIRS))
    colour, grey = np.asarray(brdf.diffuse, float), np.full(3, 0.5)

    def ours(value: Any) -> Values:
        return evaluator(dataclasses.replace(brdf, diffuse=jnp.asarray(value)))(wi, wo)

    def theirs(value: Any) -> Values:
        return by_mitsuba(plugin | {"diffuse_reflectance": rgb(value)})(wi, wo)

    cosines, black = wi[:, 2:] * wo[:, 2:], np.zeros(3)
    share = np.sum((ours(grey) - ours(black)) * cosines)
    share /= np.sum((theirs(grey) - theirs(black)) * cosines)
    inside = float(
        1 - fresnel.diffuse_transmittance(jnp.asarray(brdf.eta)) / brdf.eta**2
    )
    wanted = share * colour / (1 - colour * inside)
    changed = np.clip(wanted / (1 + wanted * inside), 0, 1)
    return plugin | {"diffuse_reflectance": rgb(changed)}


def nearest(brdf: AbstractBRDF) -> Plugin:
    """The `principled` that comes nearest to a BRDF."""
    base = colour(brdf)
    starts = [
        {"base_color": base, "metallic": metallic, "roughness": roughness, "eta": 1.5}
        for metallic in (0.05, 0.95)
        for roughness in ROUGHNESSES
    ]
    found = match(brdf, disney, starts, BOUNDS)
    told = {name: plain(value) for name, value in found.items()}
    return {"type": "principled"} | told | {"base_color": rgb(told["base_color"])}


def disney(parameters: dict[str, Any], wi: Any, wo: Any) -> Any:
    """What Mitsuba's `principled` computes without sheen and coat."""
    p = {name: jnp.asarray(value, wi.dtype) for name, value in parameters.items()}
    highlight, cos_d = gloss(wi, wo, p["roughness"], separable=True)
    base = p["base_color"] * diffuse(wi[2], wo[2], cos_d, p["roughness"])
    metal = fresnel.schlick(cos_d, p["base_color"])
    glassy = fresnel.dielectric(cos_d, p["eta"])
    mixed = p["metallic"] * metal + (1 - p["metallic"]) * glassy
    return (1 - p["metallic"]) * base + mixed * highlight


def by_mitsuba(plugin: Plugin) -> Evaluate:
    """Mitsuba's own evaluation of a plugin."""
    import mitsuba

    mitsuba.set_variant(VARIANT)
    bsdf, context = mitsuba.load_dict(plugin), mitsuba.BSDFContext()

    def evaluate(wi: Vectors, wo: Vectors) -> Values:
        interaction = mitsuba.SurfaceInteraction3f()
        found = np.empty((len(wi), 3))
        for place, (i, o) in enumerate(zip(wi.tolist(), wo.tolist(), strict=True)):
            interaction.wi = mitsuba.Vector3f(i)
            found[place] = bsdf.eval(context, interaction, mitsuba.Vector3f(o))
        return found / wo[:, 2:]

    return evaluate


def write(plugin: Plugin, path: Path) -> None:
    """Write a scene that holds nothing but the plugin, under the name of the file.

    Raises:
        OSError: The file cannot be written.
    """
    scene = ElementTree.Element("scene", version="3.0.0")
    add(scene, plugin, {"id": path.stem})
    ElementTree.indent(scene, "    ")
    with replacing(path) as temporary:
        ElementTree.ElementTree(scene).write(temporary, encoding="utf-8")


def add(parent: ElementTree.Element, plugin: Plugin, label: dict[str, str]) -> None:
    """Add a plugin with its parameters to an element of XML."""
    element = ElementTree.SubElement(parent, "bsdf", label | {"type": plugin["type"]})
    for name, value in plugin.items():
        if isinstance(value, dict) and value["type"] == "rgb":
            words = ", ".join(str(number) for number in value["value"])
            ElementTree.SubElement(element, "rgb", name=name, value=words)
        elif isinstance(value, dict):
            add(element, value, {})
        elif isinstance(value, bool):
            words = str(value).lower()
            ElementTree.SubElement(element, "boolean", name=name, value=words)
        elif isinstance(value, float):
            ElementTree.SubElement(element, "float", name=name, value=str(value))
        elif name != "type":
            ElementTree.SubElement(element, "string", name=name, value=value)
