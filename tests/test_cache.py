import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import brdffit
from brdffit.cache import enable_compilation_cache

SOURCE = str(Path(brdffit.__file__).parents[1])

FIT = """
import jax
import numpy as np

missed, traced = [], []
jax.monitoring.register_event_listener(
    lambda event, **_: missed.append(event) if event.endswith("cache_misses") else None
)
def listen(event, seconds, fun_name="", **_):
    if event.endswith("jaxpr_trace_duration") and fun_name in ("_solve", "_at"):
        traced.append(fun_name)
jax.monitoring.register_event_duration_secs_listener(listen)
import brdffit

assert jax.config.jax_compilation_cache_dir is None, "importing changes no setting"
print(brdffit.enable_compilation_cache())
instrument = brdffit.Goniometer([30], range(0, 80, 10), [0, 180])
data = brdffit.simulate_measurement(brdffit.MODELS["lambert"](albedo=[0.5]), instrument)
print(brdffit.fit("lambert", data).cost)
print(len(missed))
print(len(traced))
"""


MOVE = """
import jax
import brdffit

for number in range(2):
    print(brdffit.enable_compilation_cache(f"kept{number}"))
    jax.jit(lambda x: x + number)(1.0)
"""


def python(program, **options):
    """Standard output of a program in a process that has not heard of JAX's cache."""
    plain = {key: value for key, value in os.environ.items() if key[:4] != "JAX_"}
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=plain | options.pop("environment", {}),
        capture_output=True,
        text=True,
        check=False,
        **options,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


def run(folder):
    """Folder used, cost of the fit, programs compiled, programs of the fit traced."""
    output = python(FIT, environment={"BRDFFIT_CACHE": str(folder)}).split()
    used, cost, missed, traced = output
    return used, cost, int(missed), int(traced)


def test_a_second_fit_finds_all_its_programs(tmp_path):
    folder = tmp_path / "kept"
    used, cost, missed, traced = run(folder)
    assert used == str(folder)
    assert missed > 5
    assert traced > 1
    assert run(folder) == (str(folder), cost, 0, 0)


def test_processes_at_the_same_time_share_a_folder(tmp_path):
    folder = tmp_path / "kept"
    with ThreadPoolExecutor(2) as pool:
        one, other = pool.map(run, [folder, folder])
    assert one[1] == other[1]
    assert run(folder) == (str(folder), one[1], 0, 0)
    assert not list((folder / "executables").glob(".*")), "nothing is left half-written"


def test_executables_of_a_folder_that_is_not_safe_are_not_used(tmp_path):
    executables = tmp_path / "executables"
    executables.mkdir()
    executables.chmod(0o777)
    *_, traced = run(tmp_path)
    assert traced > 1
    assert not list(executables.iterdir())


def test_the_folder_can_be_changed_later(tmp_path):
    folders = python(MOVE, cwd=tmp_path, environment={"PYTHONPATH": SOURCE}).split()
    for folder in folders:
        assert list((tmp_path / folder).glob("jit*-cache")), folder


def test_nothing_is_kept_when_switched_off(monkeypatch):
    monkeypatch.setenv("BRDFFIT_CACHE", "off")
    assert enable_compilation_cache() is None


@pytest.mark.filterwarnings("error")
def test_a_folder_that_cannot_be_written_only_costs_time(tmp_path):
    taken = tmp_path / "taken"
    taken.touch()
    assert enable_compilation_cache(taken / "below") is None
