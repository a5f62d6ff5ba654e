from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit import compiled as module, executables, identity
from brdffit.compiled import compiled, make_room
from brdffit.executables import Executables
from brdffit.numerics import norm

X = np.array([3.0, 4.0], np.float32)


@pytest.fixture
def store(tmp_path, monkeypatch):
    """A store, on for this test, and the names of what is traced meanwhile."""
    kept, traced = Executables(tmp_path / "kept", 2**20), []

    def listen(event, duration, **facts):  # noqa: ARG001
        if event.endswith("jaxpr_trace_duration"):
            traced.append(facts["fun_name"])

    monkeypatch.setattr(executables, "store", kept)
    jax.monitoring.register_event_duration_secs_listener(listen)
    yield kept, traced
    jax.monitoring.unregister_event_duration_listener(listen)


def files(kept):
    return list(kept.folder.iterdir()) if kept.folder.is_dir() else []


def test_a_kept_program_is_neither_traced_nor_compiled_again(store):
    kept, traced = store
    assert compiled(norm)(X) == 5
    assert "norm" in traced
    assert len(files(kept)) == 1
    traced.clear()
    assert compiled(norm)(jnp.asarray(2 * X)) == 10
    assert "norm" not in traced
    assert len(files(kept)) == 1


def test_each_shape_and_setting_has_its_program(store):
    kept, _ = store
    program = compiled(norm)
    for x in (X, X[:1], X.astype(np.float16)):
        program(x)
    with jax.enable_x64(True):
        assert program(X.astype(float)).dtype == np.float64
    assert len(files(kept)) == 4


def test_a_changed_source_meets_no_stale_program(store, monkeypatch):
    kept, traced = store
    compiled(norm)(X)
    traced.clear()
    monkeypatch.setattr(identity, "_surroundings", lambda: "edited")
    assert compiled(norm)(X) == 5
    assert "norm" in traced
    assert len(files(kept)) == 2


def test_a_damaged_program_is_built_again(store):
    kept, traced = store
    compiled(norm)(X)
    (file,) = files(kept)
    whole = file.stat().st_size
    file.write_bytes(b"damaged")
    traced.clear()
    assert compiled(norm)(X) == 5
    assert "norm" in traced
    assert file.stat().st_size == pytest.approx(whole, rel=0.01)


def test_what_has_no_name_is_compiled_as_usual(store):
    kept, _ = store
    assert compiled(lambda x: jnp.sum(x))(X) == 7
    assert files(kept) == []


def test_nothing_is_kept_where_jit_is_off(store):
    kept, _ = store
    with jax.disable_jit():
        assert compiled(norm)(jnp.asarray(X)) == 5
    assert files(kept) == []


@pytest.mark.skipif(
    not Path("/proc/self/maps").exists(), reason="only Linux tells its mappings"
)
def test_programs_are_forgotten_where_there_are_too_many(store, monkeypatch):
    _, traced = store
    program = compiled(norm)
    assert program(X) == 5
    make_room()
    assert program.ready
    monkeypatch.setattr(module, "MAPPINGS", 0)
    make_room()
    assert not program.ready
    traced.clear()
    jax.jit(norm)(X)
    make_room()
    jax.jit(norm)(X)
    assert traced.count("norm") == 2
    assert program(X) == 5
