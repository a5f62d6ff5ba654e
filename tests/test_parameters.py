"""Declarations of parameters, and what models make of the numbers they are given."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import MODELS
from brdffit.models import GGX, Lambert, OrenNayar, Phong, Sum
from brdffit.parameters import (
    as_float,
    check,
    parameters,
    registry_name,
    replace,
    spectral_fields,
    values,
)


def test_declaration_says_everything_about_a_parameter():
    alpha = parameters(GGX)["alpha"]
    assert (alpha.lower, alpha.upper) == (1e-4, 1.0)
    assert alpha.typical == (0.02, 0.8)
    assert alpha.symbol == r"\alpha"
    assert (alpha.spectral, alpha.linear, alpha.logarithmic) == (False, False, True)
    assert str(alpha) == "[0.0001, 1]"
    assert str(parameters(OrenNayar)["sigma"]) == "[0, 1.5708] rad"


def test_parts_of_a_sum_have_dotted_names():
    brdf = Sum(Lambert(albedo=[0.2]), GGX(alpha=0.4, f0=[0.1]))
    assert list(parameters(brdf)) == [
        "first.albedo",
        "second.diffuse",
        "second.f0",
        "second.alpha",
    ]
    assert float(values(brdf)["second.alpha"]) == pytest.approx(0.4)


def test_replace_changes_what_is_named_and_nothing_else():
    brdf = Sum(Lambert(albedo=[0.2]), GGX(alpha=0.4, f0=[0.1]))
    changed = replace(brdf, {"second.alpha": jnp.float32(0.7)})
    assert float(changed.second.alpha) == pytest.approx(0.7)
    assert float(brdf.second.alpha) == pytest.approx(0.4)
    assert changed.first == brdf.first


def test_spectral_fields_tell_lists_from_numbers():
    assert spectral_fields(GGX) == {"diffuse": True, "f0": True, "alpha": False}


@pytest.mark.parametrize(
    ("model", "wrong", "sentence"),
    [
        (
            GGX,
            {"alpha": 3.0},
            "Parameter `alpha` of `ggx` must lie in [0.0001, 1], but",
        ),
        (GGX, {"alpha": np.nan}, "but is nan."),
        (Lambert, {"albedo": [0.2, 1.5, 0.3]}, "but is 0.2, 1.5, 0.3."),
        (OrenNayar, {"sigma": -0.1}, "must lie in [0, 1.5708] rad, but is -0.1."),
    ],
)
def test_check_names_what_is_out_of_its_interval(model, wrong, sentence):
    with pytest.raises(ValueError, match="must lie in") as error:
        check(model(**wrong))
    assert sentence in str(error.value)


@pytest.mark.parametrize("name", MODELS)
def test_defaults_and_both_bounds_pass_the_check(name):
    brdf = MODELS[name]()
    check(brdf)
    for end in ("lower", "upper"):
        known = parameters(brdf)
        bounds = {
            n: jnp.full_like(value, getattr(known[n], end))
            for n, value in values(brdf).items()
        }
        check(replace(brdf, bounds))


def test_channels_follow_the_longest_list_and_are_three_otherwise():
    assert GGX().channels == 3
    brdf = GGX(diffuse=[0.1, 0.2], f0=0.04)
    assert brdf.channels == 2
    assert brdf.f0.shape == (2,)
    assert brdf.alpha.shape == ()


def test_lists_of_different_length_are_refused():
    with pytest.raises(ValueError, match="but have diffuse 2, f0 3"):
        GGX(diffuse=[0.1, 0.2], f0=[0.1, 0.2, 0.3])


def test_a_list_for_a_number_is_refused():
    with pytest.raises(ValueError, match="`exponent` of `phong` must be one number"):
        Phong(exponent=[1.0, 2.0, 3.0])


def test_plain_numbers_become_floats_and_keep_their_precision():
    assert as_float(1).dtype == jnp.float32
    assert as_float(np.float64(1.0)).dtype == jnp.float32
    with jax.enable_x64(True):
        assert as_float(np.float64(1.0)).dtype == jnp.float64
        assert as_float(np.float32(1.0)).dtype == jnp.float32


def test_models_are_frozen():
    with pytest.raises(AttributeError):
        Lambert().albedo = jnp.zeros(3)


def test_registry_name_is_that_of_the_file_and_of_the_parts_of_a_sum():
    assert registry_name(OrenNayar) == "oren_nayar"
    assert registry_name(OrenNayar()) == "oren_nayar"
    assert registry_name(Sum(GGX(), Lambert())) == "ggx+lambert"
