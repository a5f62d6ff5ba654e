"""Parameters held, tied, free per channel, with priors; and losses that forgive."""

import jax
import jax.numpy as jnp
import numpy as np
import optimistix as optx
import pytest

import brdffit
from brdffit import MODELS, Goniometer, Noise, simulate_measurement
from brdffit.fit import load_result
from brdffit.samples import Measurement

GRID = Goniometer(
    theta_i=np.linspace(5, 75, 6), theta_o=np.linspace(2, 80, 9), phi=[0, 60, 170, 180]
)
TRUTH = MODELS["ggx"](
    diffuse=jnp.array([0.3, 0.2, 0.1]),
    f0=jnp.array([0.05, 0.05, 0.05]),
    alpha=jnp.array(0.2),
)


def measurement(brdf=TRUTH, sigma=True, seed=1):
    made = simulate_measurement(brdf, GRID, Noise(relative=0.01, seed=seed))
    fields = {"wi": made.wi, "wo": made.wo, "f_r": made.f_r}
    return Measurement(**fields, sigma=made.sigma if sigma else None)


def test_a_tied_parameter_has_one_value_in_all_channels():
    result = brdffit.fit("ggx", measurement(), tied=["f0"], starts=4)
    assert isinstance(result.parameters["f0"], float)
    assert result.brdf.f0.shape == (3,)
    assert np.ptp(result.brdf.f0) == 0
    free = brdffit.fit("ggx", measurement(), starts=4)
    error = np.mean(free.standard_errors["f0"])
    assert result.standard_errors["f0"] < 0.8 * error  # three channels know more
    assert abs(result.parameters["f0"] - 0.05) < 4 * result.standard_errors["f0"]


def test_a_parameter_per_channel_finds_each_of_them(tmp_path):
    alphas = np.array([0.1, 0.2, 0.3])
    parts = [
        measurement(MODELS["ggx"](diffuse=d, f0=0.05, alpha=a), seed=s)
        for s, (d, a) in enumerate(zip((0.3, 0.2, 0.1), alphas, strict=True))
    ]
    stack = {
        name: np.stack([getattr(p, name)[:, 0] for p in parts], axis=1)
        for name in ("f_r", "sigma")
    }
    data = Measurement(wi=parts[0].wi, wo=parts[0].wo, **stack)
    result = brdffit.fit("ggx", data, per_channel=["alpha"], starts=4)
    errors = result.standard_errors["alpha"]
    assert np.all(np.abs(result.parameters["alpha"] - alphas) < 4 * errors)
    assert result.p_value > 1e-3
    assert "per channel" in result.path
    wi, wo = jnp.asarray(data.wi[7]), jnp.asarray(data.wo[7])
    each = MODELS["ggx"](
        **{n: jnp.asarray(v) for n, v in result.parameters.items() if n != "alpha"},
        alpha=jnp.asarray(result.parameters["alpha"][1]),
    )
    np.testing.assert_allclose(result.brdf(wi, wo)[1], each(wi, wo)[1], rtol=1e-6)
    result.save(tmp_path / "result.json")
    back = load_result(tmp_path / "result.json")
    np.testing.assert_allclose(back.brdf(wi, wo), result.brdf(wi, wo), rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "residual"), [("alpha", "log"), ("diffuse", "cosine_weighted")]
)
def test_a_prior_pulls_as_hard_as_it_is_sure(name, residual):
    """Prior and data add as inverse variances, along both paths of the solver."""
    data = measurement()
    options = {"residual": residual, "starts": 2}
    without = brdffit.fit("ggx", data, **options)
    value, error = without.parameters[name], without.standard_errors[name]
    prior = (value + 2 * error, error)
    result = brdffit.fit("ggx", data, priors={name: prior}, **options)
    found, sure = result.parameters[name], result.standard_errors[name]
    np.testing.assert_allclose((found - value) / error, 1, atol=0.15)
    np.testing.assert_allclose(sure / error, np.sqrt(0.5), rtol=0.05)


def test_a_prior_without_known_errors_weighs_against_the_noise_found():
    known = brdffit.fit(
        "ggx", measurement(), priors={"alpha": (0.21, 0.001)}, residual="log", starts=2
    )
    estimated = brdffit.fit(
        "ggx",
        measurement(sigma=False),
        priors={"alpha": (0.21, 0.001)},
        residual="log",
        starts=2,
    )
    pulled = known.parameters["alpha"], estimated.parameters["alpha"]
    assert pulled[0] == pytest.approx(pulled[1], abs=2e-4)
    assert pulled[1] > 0.2


@pytest.mark.parametrize(("loss", "sigma"), [("huber", True), ("cauchy", False)])
def test_a_loss_keeps_outliers_from_leading(loss, sigma):
    data = measurement(sigma=sigma)
    rng = np.random.default_rng(5)
    wild = np.array(data.f_r)
    rows = rng.choice(len(wild), len(wild) // 20, replace=False)
    wild[rows] *= rng.uniform(3, 9, (len(rows), 3))
    fields = {"wi": data.wi, "wo": data.wo, "f_r": wild, "sigma": data.sigma}
    spoiled = Measurement(**fields)
    squares = brdffit.fit("ggx", spoiled, residual="log", starts=2)
    result = brdffit.fit("ggx", spoiled, residual="log", loss=loss, starts=2)
    assert result.loss == loss
    away = abs(result.parameters["alpha"] - 0.2)
    assert away < 0.1 * abs(squares.parameters["alpha"] - 0.2)


def test_errors_of_a_robust_fit_are_those_of_many_repetitions():
    """Without outliers, and 5 % wider than least squares, as the constants promise."""
    found, said = [], []
    for seed in range(40):
        data = measurement(seed=seed)
        result = brdffit.fit("ggx", data, residual="log", loss="huber", starts=1)
        found.append(result.parameters["alpha"])
        said.append(result.standard_errors["alpha"])
    # the scatter of 40 values is itself known to 11 %
    assert np.std(found, ddof=1) == pytest.approx(np.median(said), rel=0.4)


def test_another_solver_finds_the_same_minimum():
    data = measurement()
    own = brdffit.fit("ggx", data, residual="log", starts=2)
    solver = optx.LevenbergMarquardt(rtol=1e-10, atol=1e-10)
    other = brdffit.fit("ggx", data, residual="log", starts=2, solver=solver)
    assert other.path.startswith("plain vector of residuals; LevenbergMarquardt")
    assert other.cost == pytest.approx(own.cost, rel=1e-7)
    assert other.parameters["alpha"] == pytest.approx(own.parameters["alpha"], rel=1e-5)
    assert not jax.config.jax_enable_x64


def test_held_parameters_are_listed():
    result = brdffit.fit(
        "ggx", measurement(), fixed={"f0": [0.04, 0.05, 0.06], "alpha": 0.2}, starts=1
    )
    assert result.held == ("f0[0]", "f0[1]", "f0[2]", "alpha")
    np.testing.assert_array_equal(result.parameters["f0"], [0.04, 0.05, 0.06])


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"tied": ["alpha"]}, "`alpha` of `ggx` has one value already"),
        ({"per_channel": ["f0"]}, "`f0` of `ggx` has a value in each channel already"),
        ({"tied": ["f1"]}, "Did you mean `f0`?"),
        ({"priors": {"alhpa": (0.1, 1.0)}}, "Did you mean `alpha`?"),
        ({"priors": {"alpha": (0.1, 0.0)}}, "a standard deviation above 0"),
        (
            {"priors": {"alpha": (0.1, 0.2, 0.3)}},
            "must be a mean and a standard deviation",
        ),
        ({"fixed": {"f0": [0.1, 0.2]}}, "held at one number or 3, but is given 2"),
        ({"loss": "hubert"}, "Did you mean `huber`?"),
        ({"loss": "huber", "solver": optx.Dogleg(1e-8, 1e-8)}, "without `loss`"),
    ],
)
def test_what_cannot_be_asked_is_answered_with_a_sentence(options, sentence):
    with pytest.raises(ValueError, match=sentence):
        brdffit.fit("ggx", measurement(), **options)
