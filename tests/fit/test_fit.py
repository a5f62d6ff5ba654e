import json

import jax
import numpy as np
import pytest

import brdffit
from brdffit.fit import RESIDUALS
from brdffit.models import MODELS
from brdffit.parameters import parameters
from brdffit.samples import Measurement

LIGHTS = [
    np.array(light) / np.linalg.norm(light)
    for light in ((-0.5, 0.6, 0.62), (0.6, 0.1, 0.8), (0.8, -0.5, 0.1))
]
TRUTHS = {
    "lambert": {"albedo": [0.8, 0.5, 0.2]},
    "phong_original": {
        "diffuse": [0.1, 0.05, 0.03],
        "specular": [0.3, 0.35, 0.4],
        "exponent": 20.0,
    },
    "phong": {
        "diffuse": [0.4, 0.2, 0.1],
        "specular": [0.3, 0.35, 0.4],
        "exponent": 40.0,
    },
    "blinn_phong_original": {
        "diffuse": [0.1, 0.05, 0.03],
        "specular": [0.3, 0.35, 0.4],
        "exponent": 60.0,
    },
    "blinn_phong": {
        "diffuse": [0.4, 0.2, 0.1],
        "specular": [0.3, 0.35, 0.4],
        "exponent": 80.0,
    },
    "oren_nayar": {"albedo": [0.8, 0.5, 0.2], "sigma": 0.35},
    "cook_torrance": {
        "diffuse": [0.4, 0.2, 0.1],
        "specular": [0.5, 0.6, 0.7],
        "f0": 0.2,
        "alpha": 0.25,
    },
    "ggx": {"diffuse": [0.4, 0.2, 0.1], "f0": [0.1, 0.15, 0.2], "alpha": 0.2},
}
NOISE = brdffit.Noise(relative=0.02, additive=0.001, seed=7)


def sphere(lights):
    return brdffit.lit_sphere(64, [light.tolist() for light in lights])


def relative_errors(result, truth):
    return {
        name: np.max(np.abs(np.asarray(result.parameters[name]) / value - 1))
        for name, value in truth.items()
    }


@pytest.mark.parametrize("lights", [1, 3])
@pytest.mark.parametrize("name", TRUTHS)
def test_a_noiseless_sphere_gives_its_parameters_back(name, lights):
    truth = TRUTHS[name]
    image = brdffit.simulate_image(MODELS[name](**truth), sphere(LIGHTS[:lights]))
    result = brdffit.fit(name, image)
    assert result.converged
    lost = {label.partition("[")[0] for label in result.undetermined}
    # one light shows the Fresnel factor at one angle only
    alone = name == "cook_torrance" and lights == 1
    assert lost == ({"specular", "f0"} if alone else set())
    for parameter, error in relative_errors(result, truth).items():
        assert error < 1e-3 or parameter in lost, parameter
    if alone:
        determined = np.array(truth["specular"]) / truth["specular"][0]
        found = result.parameters["specular"] / result.parameters["specular"][0]
        np.testing.assert_allclose(found, determined, rtol=1e-3)
        sentence = result.undetermined["f0"]
        assert "`f0` and `specular` cannot be told apart" in sentence
        assert np.isinf(result.standard_errors["f0"])


@pytest.mark.parametrize("lights", [1, 3])
@pytest.mark.parametrize("name", TRUTHS)
def test_errors_of_a_noisy_sphere_are_as_large_as_they_are_said_to_be(name, lights):
    """The squared deviations, in the covariance that the fit claims, are chi-square."""
    truth = TRUTHS[name]
    image = brdffit.simulate_image(
        MODELS[name](**truth), sphere(LIGHTS[:lights]), NOISE
    )
    result = brdffit.fit(name, image)
    assert result.converged
    deviation = np.concatenate(
        [
            np.atleast_1d(
                (np.asarray(result.parameters[n]) - v) / result.standard_errors[n]
            )
            for n, v in truth.items()
        ]
    )
    sure = np.array([label not in result.undetermined for label in result.labels])
    correlation = result.correlation[np.ix_(sure, sure)]
    deviation = deviation[sure]
    chi_square = deviation @ np.linalg.solve(correlation, deviation)
    freedom = len(deviation)
    # four standard deviations: a correct fit fails once in thousands
    assert abs(chi_square - freedom) < 4 * np.sqrt(2 * freedom) + 4
    assert 1e-3 < result.p_value < 1 - 1e-3


def goniometer(name, **truth):
    grid = brdffit.Goniometer(
        theta_i=[0.0, 20.0, 45.0, 70.0],
        theta_o=[float(theta) for theta in range(0, 81, 5)],
        phi=[0.0, 45.0, 90.0, 135.0, 180.0],
    )
    return brdffit.simulate_measurement(MODELS[name](**truth), grid)


@pytest.fixture(scope="module")
def measurement():
    return goniometer("ggx", **TRUTHS["ggx"])


@pytest.mark.parametrize("residual", RESIDUALS)
def test_every_residual_leads_to_the_truth(measurement, residual):
    result = brdffit.fit("ggx", measurement, residual=residual)
    assert result.converged
    assert max(relative_errors(result, TRUTHS["ggx"]).values()) < 1e-4
    assert set(result.costs) == set(result.rms) == set(RESIDUALS)
    assert result.cost == pytest.approx(result.costs[residual], rel=1e-6, abs=1e-12)


def test_single_precision_gives_the_same_answer(measurement):
    single = brdffit.fit("ggx", measurement, precision="float32")
    assert max(relative_errors(single, TRUTHS["ggx"]).values()) < 1e-3


def test_many_samples_are_screened_and_finished_on_all():
    image = brdffit.simulate_image(
        MODELS["ggx"](**TRUTHS["ggx"]), brdffit.lit_sphere(128), NOISE
    )
    result = brdffit.fit("ggx", image)
    assert result.count > 3 * 8192
    assert result.converged
    assert result.agreement > 0.5


def test_a_fixed_parameter_stays_where_it_is(measurement):
    result = brdffit.fit("ggx", measurement, fixed={"alpha": 0.3})
    assert result.parameters["alpha"] == 0.3
    assert result.standard_errors["alpha"] == 0
    free = brdffit.fit("ggx", measurement)
    assert result.cost > free.cost


def test_a_parameter_at_its_bound_is_exactly_there_and_said_to_be():
    """Lambert has no roughness: Oren-Nayar's sigma can only be 0."""
    result = brdffit.fit("oren_nayar", goniometer("lambert", albedo=[0.8, 0.5, 0.2]))
    assert result.parameters["sigma"] == 0
    assert result.at_bound == {"sigma": "`sigma` is at its lower bound 0."}


def test_a_parameter_without_effect_is_reported():
    """Without a highlight nothing tells its width."""
    result = brdffit.fit("phong", goniometer("lambert", albedo=[0.8, 0.5, 0.2]))
    assert "exponent" in result.undetermined
    assert np.isinf(result.standard_errors["exponent"])
    np.testing.assert_allclose(result.parameters["diffuse"], [0.8, 0.5, 0.2], rtol=1e-5)


def test_the_result_knows_the_albedo_and_reciprocity_of_its_brdf():
    matte = brdffit.fit("lambert", goniometer("lambert", albedo=[0.8, 0.5, 0.2]))
    np.testing.assert_allclose(matte.albedo, [0.8, 0.5, 0.2], rtol=1e-4)
    assert matte.reciprocity < 1e-6
    truth = TRUTHS["phong_original"]
    one_sided = brdffit.fit("phong_original", goniometer("phong_original", **truth))
    assert one_sided.reciprocity > 0.1


def test_the_result_comes_back_from_its_file(measurement, tmp_path):
    result = brdffit.fit("ggx", measurement, residual="log")
    result.save(tmp_path / "result.json")
    again = brdffit.load_result(tmp_path / "result.json")
    for name in parameters(result.brdf):
        np.testing.assert_array_equal(again.parameters[name], result.parameters[name])
    np.testing.assert_array_equal(again.correlation, result.correlation)
    assert again.costs == result.costs
    assert json.loads((tmp_path / "result.json").read_text())["model"] == "ggx"


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"f_r": np.full((9, 3), np.nan)}, "at least one usable value"),
        ({"f_r": np.zeros((9, 3))}, "at least one usable value"),
        ({"mask": np.zeros((9, 3), bool)}, "at least one usable value"),
        ({"f_r": np.full((9, 1), 0.3)}, None),
        ({"f_r": np.full((9, 3), 0.3)}, None),
    ],
)
def test_odd_data_end_with_an_answer_or_a_sentence(change, sentence):
    """Nothing usable, one channel, constant data."""
    wi = np.tile([[0.6, 0.0, 0.8]], (9, 1))
    theta = np.linspace(-1.2, 1.2, 9)
    wo = np.stack([np.sin(theta), 0 * theta, np.cos(theta)], axis=1)
    fields = {"wi": wi, "wo": wo, "f_r": np.full((9, 3), 0.2)} | change
    if sentence:
        with pytest.raises(ValueError, match=sentence):
            brdffit.fit("ggx", Measurement(**fields), residual="log")
    else:
        result = brdffit.fit("ggx", Measurement(**fields), residual="log")
        assert np.isfinite(result.cost)


def test_two_samples_are_too_few():
    w = np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]])
    with pytest.raises(ValueError, match="as many usable values as the model has"):
        brdffit.fit("ggx", Measurement(wi=w, wo=w, f_r=np.ones((2, 1))))


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"model": "ggxx"}, "Did you mean `ggx`?"),
        ({"residual": "logg"}, "Did you mean `log`?"),
        ({"fixed": {"alhpa": 1.0}}, "Did you mean `alpha`?"),
        ({"fixed": {"alpha": 3.0}}, r"must lie in \[0.0001, 1\], but is 3"),
        ({"precision": "float16"}, "must be `float64` or `float32`"),
    ],
)
def test_wrong_arguments_are_answered_with_a_sentence(measurement, arguments, sentence):
    arguments = {"model": "ggx"} | arguments
    with pytest.raises(ValueError, match=sentence):
        brdffit.fit(data=measurement, **arguments)


def test_a_fit_leaves_the_precision_of_jax_alone(measurement):
    brdffit.fit("lambert", measurement)
    assert not jax.config.jax_enable_x64
    brdf = brdffit.fit("lambert", measurement).brdf
    assert brdf.albedo.dtype == np.float32
