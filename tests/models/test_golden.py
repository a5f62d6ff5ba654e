"""Every model and every part against values worked out with 110 digits.

The file of golden cases is not part of the repository; its own `meta` says how it was
made and how close a result must be. Directions there are normalised exactly before they
are used, so they are here.
"""

import functools
import gzip
import json
from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import MODELS, numerics
from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing as g, ndf
from brdffit.parameters import spectral_fields
from tests.data import shared_data

DIRECTIONS = {
    "brdf": ("wi", "wo"),
    "mirror": ("wi",),
    "h": ("h",),
    "v": ("v",),
    "scalar": (),
}


class Entry(NamedTuple):
    """What computes an entry of the golden file, from its parameters and directions."""

    evaluate: Callable
    offset: Callable = lambda p: 0.0  # scale of what is added to a lobe
    isotropic: bool = False  # only cases with ax == ay, whose derivatives add


def model(name: str, offset: str | float = 0.0, **fields: str | float) -> Entry:
    """An entry computed by a model: its field and the parameter that goes there."""

    def evaluate(p, wi, wo):
        kind = MODELS[name]
        spectral = spectral_fields(kind)
        given = {
            field: p[source]
            if isinstance(source, str)
            else jnp.asarray(source, wi.dtype)
            for field, source in fields.items()
            if field != "separable"
        }
        options = {k: v for k, v in fields.items() if k == "separable"}
        brdf = kind(
            **{f: v[None] if spectral[f] else v for f, v in given.items()}, **options
        )
        return brdf(wi, wo)[0]

    isotropic = fields.get("alpha") == "ax"
    return Entry(evaluate, lambda p: p.get(offset, 0.0), isotropic)


def above(part: Callable, *parameters: str) -> Entry:
    """An entry that is a function of one direction, and 0 below the horizon."""

    def evaluate(p, w):
        up = w[2] > 0
        safe = jnp.where(up, w, jnp.array([0.0, 0.6, 0.8], w.dtype))
        return jnp.where(up, part(safe, *(p[name] for name in parameters)), 0.0)

    return Entry(evaluate)


def masking(area: Callable) -> Entry:
    """Masking alone from a projected area."""
    part = above(lambda v, ax, ay: v[2] / area(v, ax, ay), "ax", "ay")
    return part._replace(offset=lambda p: 1.0)


def shadowed(folded: Callable) -> Entry:
    """Masking and shadowing from a function that returns it over ``4 cos_i cos_o``."""

    def evaluate(p, wi, wo):
        up = (wi[2] > 0) & (wo[2] > 0)
        safe = jnp.array([0.0, 0.6, 0.8], wi.dtype)
        i, o = jnp.where(up, wi, safe), jnp.where(up, wo, safe)
        return jnp.where(up, 4 * i[2] * o[2] * folded(p, i, o), 0.0)

    return Entry(evaluate, lambda p: 1.0)


def smith(function: Callable, separable: bool) -> Entry:
    return shadowed(lambda p, i, o: function(i, o, p["ax"], p["ay"], separable))


def scalar(function: Callable, *parameters: str) -> Entry:
    return Entry(lambda p: function(*(p[n] for n in parameters)), lambda p: 1.0)


TWO = {"diffuse": "kd", "specular": "ks", "exponent": "p"}
WARD = {"diffuse": "rho_d", "specular": "rho_s", "alpha_x": "ax", "alpha_y": "ay"}
METAL = {"alpha": "ax", "eta": "eta", "k": "k", "specular": 1.0}
GLASS = {"alpha": "ax", "eta": "eta", "specular": 1.0}

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
    "D_beckmann": above(ndf.beckmann, "ax", "ay"),
    "D_ggx": above(ndf.ggx, "ax", "ay"),
    "D_blinn": above(ndf.blinn, "p"),
    "gtr1": above(ndf.gtr1, "alpha"),
    "gtr2": above(lambda h, alpha: ndf.ggx(h, alpha, alpha), "alpha"),
    "G1_beckmann": masking(g.area_beckmann),
    "G1_beckmann_rational": masking(g.area_beckmann_rational),
    "G1_ggx": masking(g.area_ggx),
    "G2_beckmann_sep": smith(g.smith_beckmann, True),
    "G2_beckmann_corr": smith(g.smith_beckmann, False),
    "G2_ggx_sep": smith(g.smith_ggx, True),
    "G2_ggx_corr": smith(g.smith_ggx, False),
    "G_vcavity": shadowed(lambda p, i, o: g.v_cavity(i, o)),
    "fresnel_dielectric": scalar(fresnel.dielectric, "c", "eta"),
    "fresnel_conductor": scalar(fresnel.conductor, "c", "eta", "k"),
    "schlick": scalar(fresnel.schlick, "c", "F0"),
}
ENTRIES |= {
    f"torrance_sparrow_{ndf_name}_{material}_{form}": model(
        f"{material}_{ndf_name}", separable=form == "sep", **fields
    )
    for ndf_name in ("ggx", "beckmann")
    for material, fields in (("conductor", METAL), ("dielectric", GLASS))
    for form in ("sep", "corr")
}


@functools.cache
def golden() -> dict:
    with gzip.open(shared_data("golden", "golden_sample.json.gz")) as file:
        return json.load(file)["models"]


def isotropic(case: dict) -> dict:
    """The case with one roughness: derivatives by ax and ay added."""
    d = case["d"]
    both = {"v": d["ax"]["v"] + d["ay"]["v"], "s": "ok"}
    params = {name: v for name, v in case["params"].items() if name != "ay"}
    rest = {name: v for name, v in d.items() if name != "ay"}
    return case | {"params": params, "d": rest | {"ax": both}}


def cases_of(name: str) -> list[dict]:
    cases = golden()[name]["cases"]
    if not ENTRIES[name].isotropic:
        return cases
    return [isotropic(c) for c in cases if c["params"]["ax"] == c["params"]["ay"]]


def evaluate(name: str, cases: list[dict], dtype) -> tuple:
    """Values, derivatives by the parameters and gradients, all cases in one call."""
    kind = golden()[name]["kind"]
    entry = ENTRIES[name]
    p = {
        n: np.array([c["params"][n] for c in cases], dtype) for n in cases[0]["params"]
    }
    directions = [np.array([c[n] for c in cases], dtype) for n in DIRECTIONS[kind]]

    def total(p, *directions):
        return entry.evaluate(p, *map(numerics.normalize, directions))

    numbers = tuple(range(1 + len(directions)))
    both = jax.jit(jax.vmap(jax.value_and_grad(total, numbers)))
    value, (by_parameter, *by_direction) = both(p, *directions)
    by_direction = dict(
        zip(DIRECTIONS[kind], map(np.asarray, by_direction), strict=True)
    )
    return np.asarray(value), by_parameter, by_direction


FLOOR = 1e-35  # below it float32 has no digits left to compare


class Tolerance(NamedTuple):
    """How close a result must be; the file's `meta` gives the figures for float32."""

    value: float
    derivative: float
    additive: float
    rounding: float  # of the inputs, in units of the 1e-7 that `sens` is given for

    def of(self, truth, sens, offset=0.0, scale=0.0, floor=FLOOR):
        """Absolute tolerance of a number with sensitivity ``sens``."""
        return (
            abs(truth) * (self.value + 20 * self.rounding * sens)
            + self.additive * offset
            + self.value * scale
            + floor
        )


FLOAT32 = Tolerance(2e-5, 1e-4, 1e-6, 1.0)
FLOAT64 = Tolerance(1e-12, 1e-11, 1e-13, 2e-9)


def misses(name, cases, value, by_parameter, by_direction, tolerance, precision):
    """A sentence for each number that is not as close as it must be."""
    for i, case in enumerate(cases):
        sens, skip = case.get("sens", {}), case.get("corner", {}).get(precision, [])
        offset, truth = ENTRIES[name].offset(case["params"]), case["value"]
        biggest = np.finfo(value.dtype).max

        def near(found, true, bound, what, case=case, biggest=biggest):
            if abs(true) > biggest:
                good = not np.isnan(found)
            else:
                good = np.isfinite(found) and abs(found - true) <= bound
            if not good:
                yield (
                    f"{case['id']} {what}: {found:.9g} instead of {true:.9g}, "
                    f"off by {abs(found - true) / bound:.3g} tolerances {case['tags']}"
                )

        if "value" not in skip:
            bound = tolerance.of(truth, sens.get("value", 0.0), offset)
            yield from near(value[i], truth, bound, "value")
        for parameter, d in case["d"].items():
            if "value" in skip:
                continue
            found = by_parameter[parameter][i]
            if d["s"] != "ok" or f"d/d{parameter}" in skip:
                if d["s"] != "kink" and not np.isfinite(found):
                    yield f"{case['id']} d/d{parameter}: {found}"
                continue
            size = abs(case["params"][parameter]) or 1.0
            scaled = tolerance._replace(value=tolerance.derivative)
            bound = scaled.of(d["v"], sens.get(parameter, 0.0), offset / size)
            bound += tolerance.value * abs(truth) / size
            yield from near(found, d["v"], bound, f"d/d{parameter}")
        if case.get("grad_s") is None and "grad" not in case:
            continue
        for direction, gradient in case["grad"].items():
            found = by_direction[direction][i]
            if not np.all(np.isfinite(found)):
                yield f"{case['id']} grad {direction}: {found}"
            if "near_kink" in case["tags"] or f"grad {direction}" in skip:
                continue
            scaled = tolerance._replace(value=tolerance.derivative)
            length = np.linalg.norm([c or 0.0 for c in gradient])
            bound = scaled.of(length, sens.get(f"grad_{direction}", 0.0), offset)
            bound += FLOOR * (case["cond"] or 0.0)
            bound += tolerance.value * abs(truth)
            for axis, component in enumerate(gradient):
                if component is not None:
                    yield from near(
                        found[axis], component, bound, f"grad {direction} {axis}"
                    )


@pytest.mark.parametrize("name", ENTRIES)
def test_float32_agrees_with_golden_cases(name):
    cases = cases_of(name)
    results = evaluate(name, cases, np.float32)
    assert not list(misses(name, cases, *results, FLOAT32, "f32"))


@pytest.mark.parametrize("name", ENTRIES)
def test_float64_agrees_with_golden_cases(name):
    cases = cases_of(name)
    with jax.enable_x64(True):
        results = evaluate(name, cases, np.float64)
    assert not list(misses(name, cases, *results, FLOAT64, "f64"))
