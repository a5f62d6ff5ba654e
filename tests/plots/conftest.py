import pytest

import brdffit
from brdffit import MODELS

TRUTH = MODELS["phong"](
    diffuse=[0.3, 0.2, 0.1], specular=[0.3, 0.3, 0.3], exponent=20.0
)


@pytest.fixture(scope="session")
def truth():
    return TRUTH


@pytest.fixture(scope="session")
def goniometer():
    instrument = brdffit.Goniometer([20, 50], range(0, 81, 10), [0, 90, 180])
    return brdffit.simulate_measurement(TRUTH, instrument)


@pytest.fixture(scope="session")
def sphere():
    return brdffit.simulate_image(TRUTH, brdffit.lit_sphere(32))
