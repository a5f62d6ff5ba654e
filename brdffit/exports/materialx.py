r"""MaterialX: a `standard_surface` in a .mtlx document.

Used of it are base, diffuse roughness, metalness, specular with colour, roughness and
index. What the target computes is taken from the GLSL of the MaterialX library: a
dielectric GGX lobe with multiple scattering given back lies over an Oren-Nayar base and
takes from it what it reflects on the whole; a metal has the Fresnel factor of a complex
index, told by its reflectivity and the colour of its edge.

Source:
    I. Georgiev et al., "Autodesk Standard Surface", 2019; MaterialX 1.39, `pbrlib`;
    O. Gulbrandsen, "Artist Friendly Metallic Fresnel", JCGT 3(4), 2014; E. Turquin,
    "Practical multiple scattering compensation for microfacet models", 2019, eq. 16.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jax.numpy as jnp

from brdffit import numerics
from brdffit.exports.dressing import gloss
from brdffit.exports.match import ROUGHNESSES, colour, match
from brdffit.exports.material import Material, evaluator, in_rgb, plain
from brdffit.files import replacing
from brdffit.microfacet import fresnel
from brdffit.models import AbstractBRDF

DESCRIPTION = "MaterialX document with a standard_surface"
SUFFIX = ".mtlx"

BOUNDS = {
    "base_color": (0.0, 1.0),
    "diffuse_roughness": (0.0, 1.0),
    "specular": (0.0, 1.0),
    "specular_color": (0.0, 1.0),
    "specular_roughness": (0.02, 1.0),
    "specular_IOR": (1.01, 4.0),
}
COLOURS = ("base_color", "specular_color")

# Share of light that a GGX lobe reflects, for F_0 = 1 and for the rest of Schlick's
# factor: a ratio of polynomials in cos_o and alpha, columns numerators and denominators
ALBEDO = (
    (0.1003, 0.9345, 1.0, 1.0),
    (-0.6303, -2.323, -1.765, 0.2281),  # cos_o
    (9.748, 2.229, 8.263, 15.94),  # alpha
    (-2.038, -3.748, 11.53, -55.83),  # cos_o alpha
    (29.34, 1.424, 28.96, 13.08),  # cos_o^2
    (-8.245, -0.7684, -7.507, 41.26),  # alpha^2
    (-26.44, 1.436, -36.11, 54.9),  # cos_o^2 alpha
    (19.99, 0.2913, 15.86, 300.2),  # cos_o alpha^2
    (-5.448, 0.6286, 33.37, -285.1),  # cos_o^2 alpha^2
)


def translate(brdf: AbstractBRDF, channels: Sequence[str] = ()) -> Material:
    """The `standard_surface` that comes nearest to a BRDF.

    Raises:
        ValueError: It has more channels than colours.
    """
    brdf = in_rgb(brdf, "MaterialX", channels)
    base = colour(brdf)
    gloss_over_base = {
        "base_color": base,
        "diffuse_roughness": 0.1,
        "specular": 0.8,
        "specular_color": 0.9 + 0 * base,
        "specular_IOR": 1.5,
    }
    metal = {"base_color": base, "specular_color": 0.9 + 0 * base}
    starts = [
        kind | {"specular_roughness": roughness}
        for kind in (gloss_over_base, metal)
        for roughness in ROUGHNESSES
    ]
    found = match(brdf, formula, starts, BOUNDS)
    told = complete({name: plain(value) for name, value in found.items()})
    return Material(
        evaluate=evaluator(lambda wi, wo: formula(told, wi, wo)),
        write=lambda path: write(told, path),
        parameters=told,
        evaluator="our evaluation of the formulas in MaterialX's GLSL",
        notes=(
            "The standard_surface that comes nearest is taken; its gloss dims the base "
            "and gives back what is scattered more than once.",
        ),
    )


def formula(parameters: dict[str, Any], wi: Any, wo: Any) -> Any:
    """What MaterialX computes for one pair of directions above the horizon."""
    p = {n: jnp.asarray(x, wi.dtype) for n, x in complete(parameters).items()}
    lobe, cos_d = gloss(wi, wo, p["specular_roughness"])
    alpha = p["specular_roughness"] ** 2
    low, rise = albedo(wo[2], alpha)
    lost = (1 - low - rise) / (low + rise)

    # dielectric over the base
    f = fresnel.dielectric(cos_d, p["specular_IOR"])
    normal = ((p["specular_IOR"] - 1) / (p["specular_IOR"] + 1)) ** 2
    back = 1 + f * lost
    coat = lobe * f * back * p["specular_color"] * p["specular"]
    through = 1 - (normal * low + rise) * back * p["specular"]
    base = through * p["base_color"] * oren_nayar(wi, wo, p["diffuse_roughness"])

    eta, k = metal_index(p["base_color"], p["specular"] * p["specular_color"])
    f = fresnel.conductor(cos_d, eta, k)
    metal = lobe * f * (1 + f * lost)
    return p["metalness"] * metal + (1 - p["metalness"]) * (coat + base)


def complete(parameters: dict[str, Any]) -> dict[str, Any]:
    """Parameters with those that were left out, of a metal or of a base under gloss."""
    metal = "specular" not in parameters
    return {
        "metalness": float(metal),
        "diffuse_roughness": 0.0,
        "specular": 1.0,
        "specular_IOR": 1.5,
    } | parameters


def albedo(cos_o: Any, alpha: Any) -> tuple[Any, Any]:
    """What a GGX lobe reflects on the whole: share of F_0, and of the rest."""
    x, y = cos_o, alpha
    terms = (
        jnp.ones_like(x),
        x,
        y,
        x * y,
        x * x,
        y * y,
        x * x * y,
        x * y * y,
        x * x * y * y,
    )
    a, b, c, d = jnp.stack(terms) @ jnp.asarray(ALBEDO, x.dtype)
    return jnp.clip(a / c, 0, 1), jnp.clip(b / d, 0, 1)


def oren_nayar(wi: Any, wo: Any, roughness: Any) -> Any:
    """Oren and Nayar's qualitative model of a white surface, as MaterialX writes it."""
    azimuthal = jnp.maximum(jnp.dot(wi, wo), 0) - wi[2] * wo[2]
    variance = roughness * roughness
    a = 1 - 0.5 * variance / (variance + 0.33)
    b = 0.45 * variance / (variance + 0.09)
    steep = jnp.maximum(azimuthal, 0) / jnp.maximum(wi[2], wo[2])
    return (a + b * steep) / jnp.pi


def metal_index(reflectivity: Any, edge: Any) -> tuple[Any, Any]:
    """Complex index of a metal from its reflectivity and the colour of its edge."""
    r = jnp.clip(reflectivity, 0, 0.99)
    root = numerics.sqrt(r)
    most, least = (1 + root) / (1 - root), (1 - r) / (1 + r)
    eta = most + (least - most) * edge
    square = ((eta + 1) ** 2 * r - (eta - 1) ** 2) / (1 - r)
    return eta, numerics.sqrt(jnp.maximum(square, 0))


def write(told: dict[str, Any], path: Path) -> None:
    """Write the document, checked by the MaterialX library.

    Raises:
        ImportError: The library is not installed.
        ValueError: It finds the document invalid.
        OSError: The file cannot be written.
    """
    import MaterialX

    mx: Any = MaterialX  # its names are added at run time
    library, document = mx.createDocument(), mx.createDocument()
    folders = mx.getDefaultDataLibraryFolders()
    mx.loadLibraries(folders, mx.getDefaultDataSearchPath(), library)
    document.setDataLibrary(library)
    shader = document.addNode("standard_surface", "surface", "surfaceshader")
    shader.setInputValue("base", 1.0)
    for name, value in told.items():
        shader.setInputValue(name, mx.Color3(*value) if name in COLOURS else value)
    document.addMaterialNode("brdf", shader)
    valid, complaint = document.validate()
    if not valid:
        raise ValueError(f"MaterialX finds the material invalid: {complaint}.")
    with replacing(path) as temporary:
        mx.writeToXmlFile(document, str(temporary))
