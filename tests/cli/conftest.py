import pytest

import brdffit
from brdffit.cli import main
from brdffit.writers import table


@pytest.fixture(autouse=True)
def _no_compilation_cache(monkeypatch):
    monkeypatch.setenv("BRDFFIT_CACHE", "off")


@pytest.fixture
def run(capsys):
    """Run a command in this process: its status, standard output and error."""

    def run(*words):
        status = main([str(word) for word in words])
        out, err = capsys.readouterr()
        return status, out, err

    return run


@pytest.fixture(scope="session")
def chalk(tmp_path_factory):
    """A small table of a Lambertian surface with 1 % noise, in one channel."""
    path = tmp_path_factory.mktemp("data") / "chalk.csv"
    truth = brdffit.MODELS["lambert"](albedo=[0.6])
    instrument = brdffit.Goniometer([10, 40, 70], range(0, 81, 10), [0, 90, 180])
    noise = brdffit.Noise(relative=0.01)
    table.save(brdffit.simulate_measurement(truth, instrument, noise, "chalk"), path)
    return path
