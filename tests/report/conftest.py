"""Reports of fits that were never made, as text, as files, and in a browser."""

import dataclasses
import math
import shutil

import numpy as np
import pytest

import brdffit
from brdffit import MODELS
from brdffit.fit.select import Comparison
from brdffit.report.page import page
from tests.report.browser import Browser
from tests.results import comparison_of, result_of

PHONG = MODELS["phong"](diffuse=[0.3, 0.2, 0.1], specular=[0.3] * 3, exponent=20.0)
DULL = MODELS["phong"](diffuse=[0.3, 0.2, 0.1], specular=[0.2] * 3, exponent=8.0)
LAMBERT = MODELS["lambert"](albedo=[0.4, 0.3, 0.2])
HOSTILE = '<b onclick="x()">dust</b></script>\'{{ 7 * 7 }}'


@pytest.fixture(scope="session")
def goniometer():
    instrument = brdffit.Goniometer([20, 50], range(0, 81, 10), [0, 90, 180])
    return brdffit.simulate_measurement(PHONG, instrument)


@pytest.fixture(scope="session")
def sphere():
    return brdffit.simulate_image(PHONG, brdffit.lit_sphere(48))


@pytest.fixture(scope="session")
def comparison():
    """Two models of the same name, the first the truth, and one with doubts."""
    unsure = result_of(
        LAMBERT,
        at_bound={"albedo[2]": "`albedo[2]` is at its lower bound 0."},
        undetermined={"albedo[0]": "`albedo[0]` has no effect on these data."},
        converged=False,
    )
    unsure.standard_errors["albedo"][0] = math.inf
    best = result_of(PHONG)
    signs = np.where(np.indices(best.correlation.shape).sum(axis=0) % 2, -1, 1)
    best.correlation[:] = np.where(best.correlation, 1, 0.95 * signs)
    ranked = comparison_of(PHONG, DULL, LAMBERT)
    results = (best, ranked.entries[1].result, unsure)
    pairs = zip(ranked.entries, results, strict=True)
    entries = (dataclasses.replace(entry, result=result) for entry, result in pairs)
    return dataclasses.replace(ranked, entries=tuple(entries))


@pytest.fixture(scope="session")
def compared(goniometer, comparison):
    """The page of a comparison of tables."""
    return page(comparison, goniometer)


@pytest.fixture(scope="session")
def photographed(sphere, comparison: Comparison):
    """The page of a comparison of images."""
    return page(comparison, sphere)


@pytest.fixture(scope="session")
def hostile(goniometer):
    """The page of a fit to data whose every name holds markup."""
    data = dataclasses.replace(goniometer, name=HOSTILE, channels=(HOSTILE, "G", "B"))
    result = result_of(PHONG, data=HOSTILE, channels=data.channels, status=HOSTILE)
    return page(result, data)


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """One headless Chromium for all tests."""
    chromium, driver = map(shutil.which, ("chromium", "chromedriver"))
    if not (chromium and driver):
        pytest.skip(
            "Chromium and its driver are not installed, in which pages are tested: "
            "apt-get install chromium chromium-driver"
        )
    folder = tmp_path_factory.mktemp("browser")
    with Browser(chromium, driver, folder) as opened:
        yield opened
