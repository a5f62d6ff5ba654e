import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.albedo import directional_albedo
from brdffit.models import MODELS, Banks, GGXLobe, Lambert, PhongOriginal, Sum
from brdffit.parameters import parameters, replace
from tests.sampling import incident, random_directions

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


@pytest.mark.parametrize(
    ("brdf", "reciprocal", "isotropic"),
    [
        (Sum(), True, True),
        (Lambert() + PhongOriginal(), False, True),
        (Banks() + GGXLobe(), True, False),
        (PhongOriginal() + (Lambert() + Banks()), False, False),
    ],
    ids=["default", "original Phong", "fibres", "nested"],
)
def test_facts_are_those_of_the_parts(brdf, reciprocal, isotropic):
    """What is declared of each sum holds, and what is not declared does not."""
    assert (brdf.reciprocal, brdf.isotropic) == (reciprocal, isotropic)
    assert not brdf.energy_conserving
    rng = np.random.default_rng(0)
    wi, wo = random_directions(rng, 200), random_directions(rng, 200)
    turn = jnp.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    values = jax.jit(jax.vmap(brdf))
    there = values(wi, wo)
    assert np.allclose(there, values(wo, wi), rtol=1e-6) == reciprocal
    assert np.allclose(there, values(wi @ turn, wo @ turn), rtol=1e-4) == isotropic


def test_facts_of_the_class_are_those_of_the_default_pair():
    assert (Sum.reciprocal, Sum.isotropic, Sum.energy_conserving) == (True, True, False)


def test_parts_that_conserve_energy_may_not_do_so_together():
    both = Lambert(albedo=[1.0]) + GGXLobe(f0=[0.0], alpha=0.3)
    assert both.first.energy_conserving
    assert both.second.energy_conserving
    wi = jnp.asarray(incident(80), jnp.float32)
    assert jax.jit(directional_albedo)(both, wi)[0] > 1.05
