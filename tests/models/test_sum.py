import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.models import MODELS, GGXLobe, Lambert, Sum
from brdffit.parameters import parameters, replace

WI, WO = jnp.array([0.6, 0.0, 0.8]), jnp.array([-0.6, 0.0, 0.8])


def test_plus_adds_values():
    base, lobe = Lambert(albedo=0.3), GGXLobe(f0=0.1, alpha=0.2)
    assert np.allclose((base + lobe)(WI, WO), base(WI, WO) + lobe(WI, WO))


def test_parameters_carry_the_names_of_their_parts():
    two_lobes = Lambert() + GGXLobe() + GGXLobe()
    assert list(parameters(two_lobes)) == [
        "first.first.albedo",
        "first.second.f0",
        "first.second.alpha",
        "second.f0",
        "second.alpha",
    ]
    sharper = replace(two_lobes, {"second.alpha": jnp.array(0.01)})
    assert sharper.first.second.alpha == two_lobes.first.second.alpha
    assert sharper(WI, WO)[0] > two_lobes(WI, WO)[0]


def test_the_default_is_a_base_with_a_lobe():
    assert isinstance(MODELS["sum"](), Sum)
    assert list(parameters(Sum())) == ["first.albedo", "second.f0", "second.alpha"]


def test_value_is_zero_below_the_horizon():
    assert np.all(Sum()(WI, -WO) == 0)


def test_parts_must_have_the_same_channels():
    sentence = "same number of channels, but `first` has 1 and `second` 3"
    with pytest.raises(ValueError, match=sentence):
        Lambert(albedo=[0.5]) + GGXLobe(f0=[0.1, 0.2, 0.3])
