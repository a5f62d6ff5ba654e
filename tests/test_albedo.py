"""Albedo against closed forms, facts of the literature and finer rules."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import MODELS, directional_albedo
from brdffit.albedo import hemispherical_albedo
from brdffit.models import Sum

ANGLES = (0.0, 30.0, 60.0, 80.0, 89.0)

LOBE = {"diffuse": [0.0], "specular": [1.0]}
METAL = {"specular": [1.0], "alpha": 0.3, "eta": [0.2], "k": [3.9]}
GLASS = {"specular": [1.0], "alpha": 0.3, "eta": 1.5}
ALUMINIUM = {"eta": [0.96], "k": [6.7], "diffuse": [0.0], "wavelengths": [0.5]}
MIRROR = {"diffuse": [0.0], "specular": [1.0], "f0": 1.0}

# directional albedo at ANGLES by adaptive quadrature with many digits
FACTS = [
    ("lambert", {"albedo": [1.0]}, (1, 1, 1, 1, 1)),
    (
        "oren_nayar",
        {"albedo": [1.0], "sigma": 0.3},
        (0.892857, 0.920222, 0.959936, 0.991431, 1.004090),
    ),
    (
        "oren_nayar_full",
        {"albedo": [1.0], "sigma": 0.3},
        (0.962403, 0.964439, 0.983266, 1.015792, 1.044222),
    ),
    ("eon", {"albedo": [1.0], "roughness": 1.0}, (1, 1, 1, 1, 1)),
    (
        "eon",
        {"albedo": [0.5], "roughness": 1.0},
        (0.439034, 0.442321, 0.463258, 0.487572, 0.498814),
    ),
    (
        "phong_original",
        {"diffuse": [0.5], "specular": [0.5], "exponent": 10.0},
        (1.832596, 1.832597, 1.835075, 1.914624, 3.550303),
    ),
    (
        "phong",
        LOBE | {"exponent": 10.0},
        (1.000000, 0.866029, 0.504736, 0.228056, 0.131960),
    ),
    (
        "blinn_phong_original",
        {"diffuse": [0.5], "specular": [0.5], "exponent": 10.0},
        (2.321132, 2.267947, 2.171551, 2.332705, 6.138098),
    ),
    (
        "blinn_phong",
        LOBE | {"exponent": 1000.0},
        (1.000000, 0.750500, 0.251500, 0.032097, 0.001826),
    ),
    (
        "cook_torrance",
        MIRROR | {"alpha": 0.1},
        (1.000000, 1.000000, 0.999071, 0.941691, 0.983587),
    ),
    (
        "cook_torrance",
        MIRROR | {"alpha": 1.0},
        (0.453447, 0.529588, 0.791715, 0.938454, 0.993917),
    ),
    ("conductor_ggx", METAL, (0.835088, 0.821779, 0.778965, 0.802757, 0.919919)),
    (
        "conductor_ggx",
        METAL | {"separable": True},
        (0.835088, 0.821540, 0.775583, 0.777031, 0.830482),
    ),
    ("conductor_beckmann", METAL, (0.951622, 0.943103, 0.874485, 0.865681, 0.936402)),
    ("dielectric_ggx", GLASS, (0.035597, 0.037608, 0.060983, 0.124530, 0.186290)),
    (
        "dielectric_ggx",
        GLASS | {"alpha": 0.01},
        (0.039997, 0.041537, 0.089242, 0.384635, 0.759663),
    ),
    ("dielectric_beckmann", GLASS, (0.040217, 0.043314, 0.077016, 0.182252, 0.304162)),
    (
        "ward",
        LOBE | {"alpha_x": 0.05, "alpha_y": 0.4},
        (0.824546, 0.714222, 0.413017, 0.145759, 0.043869),
    ),
    (
        "ward_duer",
        LOBE | {"alpha_x": 0.3, "alpha_y": 0.3},
        (0.856312, 0.854845, 0.824024, 0.918236, 4.294864),
    ),
    (
        "ward_bounded",
        LOBE | {"alpha_x": 0.01, "alpha_y": 0.01},
        (0.999900, 0.999883, 0.999750, 0.998284, 0.873527),
    ),
    (
        "banks",
        LOBE | {"exponent": 100.0},
        (0.495171, 0.372604, 0.127470, 0.019630, 0.003214),
    ),
    (
        "ashikhmin_shirley",
        LOBE | {"exponent_u": 1000.0, "exponent_v": 10.0},
        (0.838723, 0.835526, 0.821805, 0.753577, 0.537501),
    ),
    (
        "lafortune",
        {"diffuse": [0.3], "specular": [0.5], "exponent": 10.0}
        | {"c_x": -0.9, "c_y": -0.9, "c_z": 0.9},
        (0.391284, 0.379054, 0.346074, 0.320818, 0.312046),
    ),
    (
        "he",
        ALUMINIUM | {"sigma0": 0.18, "tau": 3.0},
        (0.921216, 0.920435, 0.893832, 0.420186, 0.039912),
    ),
    (
        "he",
        ALUMINIUM | {"sigma0": 0.05, "tau": 3.0},
        (0.731294, 0.638894, 0.295837, 0.045387, 0.010721),
    ),
    (
        "ggx_multiscatter",
        {"diffuse": [0.0], "f0": [0.5], "alpha": 0.5},
        (0.415092, 0.414056, 0.422974, 0.469867, 0.532415),
    ),
    ("ggx_multiscatter", {"diffuse": [0.0], "f0": [1.0], "alpha": 1.0}, (1,) * 5),
    ("ggx_multiscatter", {"diffuse": [0.0], "f0": [1.0], "alpha": 0.05}, (1,) * 5),
    (
        "principled",
        {"base": [1.0], "metallic": 1.0, "roughness": 0.5, "separable": True},
        (0.915812, 0.904024, 0.855099, 0.835117, 0.889985),
    ),
]


def incident(degrees, azimuth=0.0):
    """Direction computed in float64, so that grazing cosines keep their digits."""
    theta, phi = np.radians(degrees), np.radians(azimuth)
    across = np.sin(theta)
    return jnp.asarray(
        [across * np.cos(phi), across * np.sin(phi), np.cos(theta)], jnp.float32
    )


albedo_at = jax.jit(directional_albedo)
hemispherical = jax.jit(hemispherical_albedo)


@pytest.mark.parametrize(
    ("name", "parameters", "expected"), FACTS, ids=[fact[0] for fact in FACTS]
)
def test_directional_albedo_is_that_of_the_literature(name, parameters, expected):
    brdf = MODELS[name](**parameters)
    found = [float(albedo_at(brdf, incident(angle))[0]) for angle in ANGLES]
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("alpha", [1e-4, 1e-2, 1.0])
def test_smooth_and_rough_lobes_are_not_lost(alpha):
    lobe = MODELS["ggx_lobe"](f0=[1.0], alpha=alpha)
    expected = {1e-4: 1.0, 1e-2: 0.999899, 1.0: 1 - np.log(2)}[alpha]
    assert float(albedo_at(lobe, incident(0.0))[0]) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(
    ("name", "beyond", "most"),
    [("ggx", 49.6, 1.155), ("beckmann", 15.5, 1.29), ("ggx_multiscatter", 47.9, 1.155)],
)
def test_base_that_a_lobe_does_not_attenuate_reflects_too_much(name, beyond, most):
    brdf = MODELS[name](diffuse=[0.96], f0=[0.04], alpha=0.3)
    assert float(albedo_at(brdf, incident(beyond - 1))[0]) < 1
    assert float(albedo_at(brdf, incident(beyond + 1))[0]) > 1
    assert float(albedo_at(brdf, incident(89.99))[0]) == pytest.approx(most, abs=1e-3)


def test_isotropic_models_do_not_see_the_azimuth_of_light():
    brdf = MODELS["phong"](diffuse=[0.0], specular=[1.0], exponent=1e5)
    along, across = (albedo_at(brdf, incident(85.0, phi)) for phi in (0.0, 77.0))
    assert float(along[0]) == pytest.approx(float(across[0]), rel=1e-5)


def test_lobe_away_from_the_mirror_direction_is_found():
    """A narrow Lafortune lobe that leans towards grazing holds what its peak says."""
    brdf = MODELS["lafortune"](
        diffuse=[0.0], specular=[1.0], c_x=-1.0, c_y=-1.0, c_z=0.7, exponent=2000.0
    )
    wi = incident(40.0)
    peak = np.array([-1.0, -1.0, 0.7]) * np.asarray(wi)
    length = np.linalg.norm(peak)
    # the integral of length^p cos^p over the whole lobe, times the cosine at its peak
    expected = length**2000 * 2 * np.pi / 2001 * peak[2] / length
    assert float(albedo_at(brdf, wi)[0]) == pytest.approx(expected, rel=2e-3)


def test_albedo_of_a_sum_is_the_sum_of_albedos():
    first, second = MODELS["lambert"](albedo=[0.3]), MODELS["ggx_lobe"](f0=[0.5])
    both, wi = Sum(first, second), incident(70.0)
    parts = albedo_at(first, wi) + albedo_at(second, wi)
    assert jnp.allclose(albedo_at(both, wi), parts)
    parts = hemispherical(first) + hemispherical(second)
    assert jnp.allclose(hemispherical(both), parts)


# by adaptive quadrature with many digits, azimuth in closed form
@pytest.mark.parametrize(
    ("degrees", "expected"), [(89.0, 0.9999834), (89.9, 0.9981945), (89.99, 0.9049331)]
)
def test_lobe_narrower_than_the_rounding_of_directions_is_not_lost(degrees, expected):
    lobe = MODELS["ggx_lobe"](f0=[1.0], alpha=1e-4)
    found = float(albedo_at(lobe, incident(degrees))[0])
    assert found == pytest.approx(expected, abs=1e-6)


def test_albedo_has_a_gradient():
    """The derivative by alpha is the limit of differences, both ways."""
    wi = incident(60.0)

    def reflected(alpha):
        return directional_albedo(MODELS["ggx_lobe"](f0=[1.0], alpha=alpha), wi)[0]

    slope, same = (
        jax.jit(derivative(reflected))(jnp.float32(0.5))
        for derivative in (jax.grad, jax.jacfwd)
    )
    value = jax.jit(reflected)
    difference = float(value(0.51) - value(0.49)) / 0.02
    assert float(slope) == pytest.approx(difference, rel=1e-3)
    assert float(slope) == float(same)


@pytest.mark.parametrize(
    ("brdf", "expected"),
    [
        (MODELS["lambert"](albedo=[0.3, 0.6]), (0.3, 0.6)),
        (MODELS["phong"](diffuse=[0.0], specular=[1.0], exponent=0.0), None),
    ],
    ids=["lambert", "phong"],
)
def test_hemispherical_albedo_averages_over_incidence(brdf, expected):
    angles = np.degrees(np.arccos(np.sqrt((np.arange(200) + 0.5) / 200)))
    if expected is None:
        table = jax.lax.map(
            lambda wi: directional_albedo(brdf, wi)[0],
            jnp.stack([incident(a) for a in angles]),
        )
        expected = (float(table.mean()),)
    np.testing.assert_allclose(hemispherical(brdf), expected, atol=1e-4)


def test_anisotropic_lobe_is_averaged_over_azimuth():
    brdf = MODELS["ward_bounded"](
        diffuse=[0.0], specular=[1.0], alpha_x=0.05, alpha_y=0.5
    )
    turned = MODELS["ward_bounded"](
        diffuse=[0.0], specular=[1.0], alpha_x=0.5, alpha_y=0.05
    )
    a, b = (float(hemispherical(m)[0]) for m in (brdf, turned))
    assert a == pytest.approx(b, rel=1e-4)
    assert 0.7 < a < 1
