"""The golden cases: which part of the package computes each entry, and the cases.

An entry is a function of its parameters by the names of the file and of its directions,
for one case.
"""

import functools
import gzip
import json
from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp

from brdffit import numerics
from brdffit.geometry import bisector
from brdffit.microfacet import (
    diffraction,
    fresnel,
    masking_shadowing as masking,
    multiple_scattering,
    ndf,
)
from brdffit.models import MODELS, He, principled
from brdffit.parameters import spectral_fields
from tests.data import shared_data

# directions of each kind of entry
DIRECTIONS = {
    "brdf": ("wi", "wo"),
    "mirror": ("wi",),
    "h": ("h",),
    "v": ("v",),
    "scalar": (),
}

# other variants of models that the package has in one form only
WITHOUT_COUNTERPART = {
    "blinn_phong_8",
    "cook_torrance",  # with the exact dielectric Fresnel factor
    "disney_spec_2012",
    "fujii",
    "fujii_sigma",
    "ggx_turquin",
}


class Entry(NamedTuple):
    """How the package computes an entry of the file.

    ``offset`` is the scale of what is added to a lobe: a parameter, or a number.
    """

    evaluate: Callable
    offset: str | float = 0.0
    select: Callable | None = None  # returns None for a case without a counterpart

    def scale(self, case: dict) -> float:
        """The offset in a case."""
        if isinstance(self.offset, str):
            return case["params"][self.offset]
        return self.offset


def one_roughness(case: dict) -> dict | None:
    """A case with ``ax == ay`` as one of a single roughness: derivatives add."""
    if case["params"]["ax"] != case["params"]["ay"]:
        return None
    d = case["d"]
    both = {"v": d["ax"]["v"] + d["ay"]["v"], "s": "ok"}
    return without(case, "ay") | {"d": without(case, "ay")["d"] | {"ax": both}}


def no_anisotropy(case: dict) -> dict | None:
    return None if case["params"]["aniso"] else without(case, "aniso")


def without(case: dict, parameter: str) -> dict:
    keep = {
        key: {name: v for name, v in case[key].items() if name != parameter}
        for key in ("params", "d")
    }
    return case | keep


def model(
    name: str,
    offset: str | float = 0.0,
    separable: bool | None = None,
    **fields: str | float,
) -> Entry:
    """An entry computed by a model: for each field a parameter, or a number."""
    option = {} if separable is None else {"separable": separable}

    def evaluate(p, wi, wo):
        spectral = spectral_fields(MODELS[name])
        given = {}
        for field, source in fields.items():
            number = p[source] if isinstance(source, str) else source
            shape = (1,) * spectral[field]
            given[field] = jnp.reshape(jnp.asarray(number, wi.dtype), shape)
        return MODELS[name](**given, **option)(wi, wo)[0]

    return Entry(
        evaluate, offset, one_roughness if fields.get("alpha") == "ax" else None
    )


def visible(part: Callable, offset: str | float = 0.0) -> Entry:
    """An entry that is 0 when one of its directions is not above the horizon."""

    def evaluate(p, *directions):
        up = jnp.all(jnp.stack([w[2] > 0 for w in directions]))
        harmless = [[0.6, 0.0, 0.8], [0.0, 0.6, 0.8]]
        shown = (
            jnp.where(up, w, jnp.array(safe, w.dtype))
            for w, safe in zip(directions, harmless, strict=False)
        )
        return jnp.where(up, part(p, *shown), 0.0)

    return Entry(evaluate, offset)


def masked(area: Callable) -> Entry:
    """Masking alone, from a projected area."""
    return visible(lambda p, v: v[2] / area(v, p["ax"], p["ay"]), 1.0)


def smith(function: Callable, separable: bool) -> Entry:
    """Masking and shadowing, from a function that divides them by ``4 cos_i cos_o``."""

    def part(p, i, o):
        return 4 * i[2] * o[2] * function(i, o, p["ax"], p["ay"], separable)

    return visible(part, 1.0)


def slopes(function: Callable, *names: str) -> Entry:
    """An ndf."""
    return visible(lambda p, h: function(h, *(p[name] for name in names)))


def scalar(function: Callable, *names: str) -> Entry:
    """A function of numbers alone, of the order of 1."""
    return Entry(lambda p: function(*(p[name] for name in names)), 1.0)


def v_cavity(p, i, o):
    del p
    return 4 * i[2] * o[2] * masking.v_cavity(i, o)


def he(p):
    lengths = {name: p[name] for name in ("sigma0", "tau")}
    metal = {"eta": p["n"][None], "k": p["k"][None]}
    scattered = jnp.pi * p.get("a_ud", jnp.zeros_like(p["n"]))
    return He(**lengths, **metal, diffuse=scattered[None], wavelengths=p["lam"][None])


def blinn(p, h):
    alpha = numerics.sqrt(2 / (p["p"] + 2))
    return ndf.blinn(h, alpha, alpha)


def series_of_he(g, c):
    return diffraction.scattering_lobe(g, c / (1 + g)) / (1 + g)


def base_of_principled(p, wi, wo):
    cos_d = fresnel.cos_d(bisector(wi, wo))
    return p["base"] * principled.diffuse(wi[2], wo[2], cos_d, p["roughness"])


def coat_of_principled(p, wi, wo):
    return p["clearcoat"] * principled.clearcoat(wi, wo, p["gloss"], True)


TWO = {"diffuse": "kd", "specular": "ks", "exponent": "p"}
WARD = {"diffuse": "rho_d", "specular": "rho_s", "alpha_x": "ax", "alpha_y": "ay"}
FACETS = {
    "conductor": {"alpha": "ax", "eta": "eta", "k": "k", "specular": 1.0},
    "dielectric": {"alpha": "ax", "eta": "eta", "specular": 1.0},
}

ENTRIES = {
    "lambert": model("lambert", "rho", albedo="rho"),
    "phong_original": model("phong_original", "kd", **TWO),
    "phong": model("phong", "kd", **TWO),
    "blinn_phong_original": model("blinn_phong_original", "kd", **TWO),
    "blinn_phong": model("blinn_phong", "kd", **TWO),
    "oren_nayar": model("oren_nayar", "rho", albedo="rho", sigma="sigma"),
    "oren_nayar_full": model("oren_nayar_full", "rho", albedo="rho", sigma="sigma"),
    "eon": model("eon", "rho", albedo="rho", roughness="r"),
    "cook_torrance_schlick": model(
        "cook_torrance", "kd", diffuse="kd", specular="ks", f0="F0", alpha="m"
    ),
    "ward": model("ward", "rho_d", **WARD),
    "ward_duer": model("ward_duer", "rho_d", **WARD),
    "ward_gmd": model("ward_bounded", "rho_d", **WARD),
    "banks": model("banks", "kd", **TWO),
    "ashikhmin_shirley": model(
        "ashikhmin_shirley",
        "Rd",
        diffuse="Rd",
        specular="Rs",
        exponent_u="nu",
        exponent_v="nv",
    ),
    "lafortune": model("lafortune", "kd", c_x="Cx", c_y="Cy", c_z="Cz", **TWO),
    "ggx_kulla_conty": model("ggx_multiscatter", diffuse=0.0, f0="F0", alpha="alpha"),
    "disney_diffuse": visible(base_of_principled, "base"),
    "disney_clearcoat": visible(coat_of_principled),
    "disney_spec": model(
        "principled", base="F0", roughness="roughness", metallic=1.0, separable=True
    )._replace(select=no_anisotropy),
    "he": Entry(lambda p, wi, wo: he(p)(wi, wo)[0], "a_ud"),
    "he_spec": visible(lambda p, wi: he(p).specular_reflectance(wi)[0]),
    "he_series": Entry(lambda p: series_of_he(p["g"], p["c"])),
    "D_beckmann": slopes(ndf.beckmann, "ax", "ay"),
    "D_ggx": slopes(ndf.ggx, "ax", "ay"),
    "D_blinn": visible(blinn),
    "gtr1": slopes(ndf.gtr1, "alpha", "alpha"),
    "gtr2": slopes(ndf.ggx, "alpha", "alpha"),
    "G1_beckmann": masked(masking.area_beckmann),
    "G1_beckmann_rational": masked(masking.area_beckmann_rational),
    "G1_ggx": masked(masking.area_ggx),
    "G2_beckmann_sep": smith(masking.smith_beckmann, True),
    "G2_beckmann_corr": smith(masking.smith_beckmann, False),
    "G2_ggx_sep": smith(masking.smith_ggx, True),
    "G2_ggx_corr": smith(masking.smith_ggx, False),
    "G_vcavity": visible(v_cavity, 1.0),
    "fresnel_dielectric": scalar(fresnel.dielectric, "c", "eta"),
    "fresnel_conductor": scalar(fresnel.conductor, "c", "eta", "k"),
    "schlick": scalar(fresnel.schlick, "c", "F0"),
    "ggx_E": scalar(
        lambda mu, alpha: 1 - multiple_scattering.missing_albedo(mu, alpha),
        "mu",
        "alpha",
    ),
    "ggx_Eavg": scalar(
        lambda alpha: 1 - multiple_scattering.average_missing_albedo(alpha), "alpha"
    ),
} | {
    f"torrance_sparrow_{slope}_{material}_{form}": model(
        f"{material}_{slope}", separable=form == "sep", **fields
    )
    for slope in ("ggx", "beckmann")
    for material, fields in FACETS.items()
    for form in ("sep", "corr")
}


@functools.cache
def golden() -> dict:
    """Entries of the file by name."""
    with gzip.open(shared_data("golden", "golden_sample.json.gz")) as file:
        return json.load(file)["models"]


def cases_of(name: str) -> list[dict]:
    """Cases of an entry that the package computes."""
    cases, select = golden()[name]["cases"], ENTRIES[name].select
    return cases if select is None else [c for c in map(select, cases) if c is not None]
