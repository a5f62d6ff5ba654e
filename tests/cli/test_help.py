import subprocess
import sys

import pytest

HEAVY = ("jax", "equinox", "numpy", "scipy", "matplotlib", "colour", "OpenEXR")
PROGRAM = f"""
import sys, time
from brdffit.cli import main
status = main({{arguments!r}})
print(status, time.process_time(), [n for n in {HEAVY!r} if n in sys.modules])
"""


def last_line_of(arguments):
    code = PROGRAM.format(arguments=arguments)
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    return done.stdout.splitlines()[-1].split(maxsplit=2)


@pytest.mark.parametrize(
    "arguments", [["--help"], ["compare", "--help"], ["--version"]]
)
def test_help_comes_at_once_and_loads_nothing_heavy(arguments):
    status, seconds, loaded = last_line_of(arguments)
    assert status == "0"
    assert loaded == "[]"
    assert float(seconds) < 0.7  # of one core; 0.2 where nothing else runs


def test_a_fit_without_pictures_loads_nothing_that_draws(chalk):
    fit = ["fit", str(chalk), "--model", "lambert"]
    status, _, loaded = last_line_of(fit)
    assert status == "0"
    assert "matplotlib" not in loaded
    assert "colour" not in loaded


def test_every_command_has_its_line(run):
    status, out, err = run("--help")
    assert (status, err) == (0, "")
    for command in ("demo", "models", "fit", "compare", "simulate", "render"):
        assert f"\n│ {command}" in out


def test_every_option_of_a_fit_is_explained(run):
    _, out, _ = run("fit", "--help")
    for option in ("--model", "--residual", "--starts", "--fix", "--channels", "--out"):
        assert option in out
    assert "--no-" not in out
