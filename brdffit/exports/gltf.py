r"""glTF 2.0: the metallic-roughness material, as a file with nothing but a material.

The target computes, with base colour $b$, metallic $m$, roughness $r$ and
$\alpha = r^2$,

$$f_r = (1 - m)\,\Bigl((1 - F)\,\frac{b}{\pi} + F\,D V\Bigr)
        + m\,\bigl(b + (1 - b)(1 - c)^5\bigr)\,D V, \qquad
  F = 0.04 + 0.96\,(1 - c)^5$$

with $c = \omega_i\cdot\omega_h$ and the height-correlated GGX lobe $D V$.

Source:
    Khronos Group, "glTF 2.0 Specification", appendix B.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jax.numpy as jnp

from brdffit.exports.dressing import gloss
from brdffit.exports.match import ROUGHNESSES, colour, match
from brdffit.exports.material import Material, evaluator, in_rgb, plain
from brdffit.files import replacing
from brdffit.microfacet import fresnel
from brdffit.models import AbstractBRDF

DESCRIPTION = "glTF 2.0 metallic-roughness material"
SUFFIX = ".gltf"

BOUNDS = {"base_color": (0.0, 1.0), "metallic": (0.0, 1.0), "roughness": (0.01, 1.0)}


def translate(brdf: AbstractBRDF, channels: Sequence[str] = ()) -> Material:
    """The metallic-roughness material that comes nearest to a BRDF.

    Raises:
        ValueError: It has more channels than colours.
    """
    brdf = in_rgb(brdf, "glTF", channels)
    base = colour(brdf)
    starts = [
        {"base_color": base, "metallic": metallic, "roughness": roughness}
        for metallic in (0.05, 0.95)
        for roughness in ROUGHNESSES
    ]
    found = match(brdf, formula, starts, BOUNDS)
    told = {name: plain(value) for name, value in found.items()}
    return Material(
        evaluate=evaluator(lambda wi, wo: formula(told, wi, wo)),
        write=lambda path: write(told, path),
        parameters=told,
        evaluator="our evaluation of the formula in the specification of glTF",
        notes=(
            "glTF has a base colour, a metallic weight and one roughness, with a "
            "reflectance of 0.04 where nothing is metal; the nearest are taken.",
        ),
    )


def formula(parameters: dict[str, Any], wi: Any, wo: Any) -> Any:
    """What glTF computes for one pair of directions above the horizon."""
    base = jnp.asarray(parameters["base_color"], wi.dtype)
    metallic, roughness = parameters["metallic"], parameters["roughness"]
    lobe, cos_d = gloss(wi, wo, roughness)
    dielectric = fresnel.schlick(cos_d, jnp.asarray(0.04, wi.dtype))
    coated = (1 - dielectric) * base / jnp.pi + dielectric * lobe
    return (1 - metallic) * coated + metallic * fresnel.schlick(cos_d, base) * lobe


def write(told: dict[str, Any], path: Path) -> None:
    """Write the file.

    Raises:
        ImportError: pygltflib is not installed.
        OSError: The file cannot be written.
    """
    import pygltflib

    document = pygltflib.GLTF2(
        asset=pygltflib.Asset(version="2.0", generator="brdffit"),
        materials=[
            pygltflib.Material(
                name=path.stem,
                pbrMetallicRoughness=pygltflib.PbrMetallicRoughness(
                    baseColorFactor=[*told["base_color"], 1.0],
                    metallicFactor=told["metallic"],
                    roughnessFactor=told["roughness"],
                ),
            )
        ],
    )
    with replacing(path) as temporary:
        document.save_json(str(temporary))
