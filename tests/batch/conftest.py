import numpy as np
import pytest

import brdffit
from brdffit.writers import table


@pytest.fixture(autouse=True)
def _no_compilation_cache(monkeypatch):
    monkeypatch.setenv("BRDFFIT_CACHE", "off")


@pytest.fixture(scope="session")
def tables(tmp_path_factory):
    """A folder with tables of two Lambertian surfaces, in one channel."""
    folder = tmp_path_factory.mktemp("tables")
    instrument = brdffit.Goniometer([10, 40, 70], range(0, 81, 10), [0, 90, 180])
    noise = brdffit.Noise(relative=0.01)
    for name, albedo in (("chalk", 0.6), ("slate", 0.1)):
        truth = brdffit.MODELS["lambert"](albedo=np.array([albedo]))
        data = brdffit.simulate_measurement(truth, instrument, noise, name)
        table.save(data, folder / f"{name}.csv")
    return folder
