"""What holds for every target, and what each is told."""

import json
import xml.etree.ElementTree as ElementTree

import jax.numpy as jnp
import MaterialX as mx
import mitsuba as mi
import numpy as np
import pytest

import brdffit
from brdffit import MODELS
from brdffit.catalogue import from_name
from brdffit.exports import EXPORTS, gltf, materialx, merl, mitsuba
from brdffit.exports.deviation import deviation, pairs
from brdffit.exports.material import evaluator
from brdffit.microfacet import fresnel

METAL = MODELS["ggx_lobe"](f0=[0.9, 0.6, 0.3], alpha=0.25)
GOLD = {"eta": [0.2, 0.5, 1.3], "k": [3.9, 2.5, 1.8]}


@pytest.mark.parametrize("target", EXPORTS)
def test_every_target_refuses_in_a_sentence(target, tmp_path):
    with pytest.raises(ValueError, match=f"must end in {EXPORTS[target].SUFFIX}"):
        brdffit.export(METAL, target, tmp_path / "x.txt")
    out = tmp_path / f"x{EXPORTS[target].SUFFIX}"
    with pytest.raises(ValueError, match="has the channels 4: fit the data in RGB"):
        brdffit.export(from_name("ggx", channels=4), target, out)
    assert not list(tmp_path.iterdir())


def test_unknown_target_suggests_the_nearest(tmp_path):
    with pytest.raises(ValueError, match="Did you mean `mitsuba`"):
        brdffit.export(METAL, "mitsubishi", tmp_path / "x.xml")


def test_a_package_that_is_missing_is_named(tmp_path, monkeypatch):
    def missing(*_):
        raise ModuleNotFoundError("No module named 'MaterialX'", name="MaterialX")

    monkeypatch.setattr(materialx, "translate", missing)
    with pytest.raises(ValueError, match="needs the package materialx, which is not"):
        brdffit.export(METAL, "materialx", tmp_path / "x.mtlx")


@pytest.mark.parametrize("target", ["mitsuba", "merl"])
def test_grain_is_refused_where_there_is_none(target, tmp_path):
    out = tmp_path / f"x{EXPORTS[target].SUFFIX}"
    with pytest.raises(ValueError, match="`banks` cannot be"):
        brdffit.export(MODELS["banks"](), target, out)


def test_gltf_holds_a_metal_exactly_and_says_what_it_was_told(tmp_path):
    path = tmp_path / "metal.gltf"
    done = brdffit.export(METAL, "gltf", path)
    (material,) = json.loads(path.read_text())["materials"]
    told = material["pbrMetallicRoughness"]
    assert told["baseColorFactor"] == pytest.approx([0.9, 0.6, 0.3, 1], abs=1e-4)
    assert (told["metallicFactor"], told["roughnessFactor"]) == pytest.approx(
        (1, 0.5), abs=1e-4
    )
    assert done.deviation.largest < 1e-4
    assert done.to_dict()["path"] == str(path)


def test_gltf_formula_is_that_of_the_specification():
    """By hand at normal incidence and view: D = 1 / (pi alpha^2), V = 1/4."""
    up = jnp.array([0.0, 0.0, 1.0])
    told = {"base_color": [0.8, 0.5, 0.2], "metallic": 0.25, "roughness": 0.5}
    lobe = 1 / (np.pi * 0.0625) / 4
    base = np.array([0.8, 0.5, 0.2])
    glass = 0.96 * base / np.pi + 0.04 * lobe
    assert np.allclose(gltf.formula(told, up, up), 0.75 * glass + 0.25 * base * lobe)


def test_materialx_is_validated_and_holds_oren_and_nayar_exactly(tmp_path):
    brdf = MODELS["oren_nayar"](albedo=[0.3, 0.4, 0.5], sigma=0.3)
    path = tmp_path / "clay.mtlx"
    done = brdffit.export(brdf, "materialx", path)
    assert done.deviation.largest < 1e-4
    document = mx.createDocument()
    mx.readFromXmlFile(document, str(path))
    (shader,) = document.getNodes("standard_surface")
    assert shader.getInputValue("diffuse_roughness") == pytest.approx(0.3, abs=1e-3)
    assert list(shader.getInputValue("base_color")) == pytest.approx(
        [0.3, 0.4, 0.5], abs=1e-3
    )


def test_index_of_a_metal_goes_through_reflectivity_and_edge():
    """The inverse of what MaterialX does (Gulbrandsen 2014, eq. 8 to 12)."""
    n, k = (np.array(GOLD[name]) for name in ("eta", "k"))
    r = ((n - 1) ** 2 + k**2) / ((n + 1) ** 2 + k**2)
    most, least = (1 + np.sqrt(r)) / (1 - np.sqrt(r)), (1 - r) / (1 + r)
    found = materialx.metal_index(
        jnp.asarray(r), jnp.asarray((most - n) / (most - least))
    )
    assert np.allclose(found, (n, k), rtol=1e-3)


def test_materialx_metal_gives_back_what_is_scattered_more_than_once():
    """Of a mirror's facets all light returns: the lobe over its share is Turquin's."""
    up = jnp.array([0.0, 0.0, 1.0])
    told = {"base_color": [0.9] * 3, "specular_color": [1.0] * 3}
    f_r = materialx.formula(told | {"specular_roughness": 0.6}, up, up)
    low, rise = materialx.albedo(jnp.float32(1), jnp.float32(0.36))
    share = float(low + rise)
    f = float(fresnel.schlick(jnp.float32(1), jnp.float32(0.9)))
    single = 1 / (np.pi * 0.36**2) / 4 * f
    assert np.allclose(f_r, single * (1 + f * (1 - share) / share), rtol=1e-4)
    assert 0.8 < share < 0.95


@pytest.mark.parametrize(
    ("name", "given", "plugin", "largest"),
    [
        ("lambert", {"albedo": [0.3, 0.4, 0.5]}, "diffuse", 1e-6),
        ("conductor_ggx", GOLD | {"alpha": 0.2}, "roughconductor", 1e-4),
        ("conductor_beckmann", GOLD | {"alpha": 0.2}, "roughconductor", 0.01),
        ("dielectric_ggx", {"alpha": 0.2, "specular": 0.7}, "roughdielectric", 1e-4),
        ("ggx_lobe", {"f0": [0.9, 0.6, 0.3]}, "principled", 1e-4),
        ("plastic_ggx", {"alpha": 0.05}, "roughplastic", 0.2),
        ("principled", {"metallic": 1.0, "roughness": 0.4}, "principled", 1e-4),
    ],
)
def test_mitsuba_reads_what_is_written(name, given, plugin, largest, tmp_path):
    options = {} if name == "lambert" else {"separable": True}
    path = tmp_path / "x.xml"
    done = brdffit.export(MODELS[name](**given, **options), "mitsuba", path)
    assert done.evaluator == "Mitsuba"
    assert done.deviation.largest < largest
    (bsdf,) = ElementTree.parse(path).getroot()
    assert (bsdf.get("type"), bsdf.get("id")) == (plugin, "x")
    mi.load_file(str(path))


def test_masking_of_mitsuba_is_told_with_its_error(tmp_path):
    brdf = MODELS["conductor_ggx"](**GOLD, alpha=0.4)
    done = brdffit.export(brdf, "mitsuba", tmp_path / "x.xml")
    (note,) = done.notes
    assert "Masking in Mitsuba is separable" in note
    assert f"largest {done.deviation.largest:.2g}" in note
    assert done.deviation.largest > 0.03


def test_mitsuba_takes_the_nearer_of_a_blend_and_its_principled(tmp_path):
    brdf = MODELS["ggx"](diffuse=[0.1, 0.05, 0.02], f0=[0.6, 0.4, 0.2], separable=True)
    path = tmp_path / "x.xml"
    done = brdffit.export(brdf, "mitsuba", path)
    assert done.parameters["type"] == "blendbsdf"
    assert "reflects 0.9 of the light towards grazing" in done.notes[0]
    assert done.deviation.mean < 0.02
    mi.load_file(str(path))


def test_any_other_model_becomes_the_nearest_principled():
    brdf = MODELS["phong"](diffuse=[0.3, 0.2, 0.1], specular=0.1, exponent=30)
    material = mitsuba.translate(brdf)
    assert material.parameters["type"] == "principled"
    assert "Mitsuba has no `phong`" in material.notes[0]
    told, truth = material.parameters, evaluator(brdf)
    matte = mitsuba.by_mitsuba({"type": "diffuse", "reflectance": told["base_color"]})
    found = deviation(truth, material.evaluate)
    assert found.mean < deviation(truth, matte).mean


def test_a_merl_file_is_the_nearest_cell(tmp_path):
    brdf = from_name("ggx", channels=1)
    path = tmp_path / "x.binary"
    done = brdffit.export(brdf, "merl", path)
    read = brdffit.readers.merl.evaluate(path, *pairs(200))
    assert np.allclose(
        read, merl.nearest(merl.tabulated(from_name("ggx")), *pairs(200))
    )
    assert 0.001 < done.deviation.mean < 0.02
