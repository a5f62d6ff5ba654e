import os
import pickle
import time

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.executables import Executables, without_cache

LIMIT = 2**20
ARGUMENTS = ({"x": np.arange(3.0, dtype=np.float32)},), {}


def twice(tree):
    return {"y": 2 * tree["x"], "sum": jnp.sum(tree["x"])}


@pytest.fixture(scope="module")
def executable():
    with without_cache():
        return jax.jit(twice).lower(*ARGUMENTS[0]).compile()


@pytest.fixture
def store(tmp_path):
    return Executables(tmp_path / "kept", LIMIT)


def file_in(store):
    (file,) = store.folder.iterdir()
    return file


def test_a_loaded_executable_gives_the_same_tree(store, executable):
    store.save("name", executable)
    loaded = store.load("name", ARGUMENTS)
    found = loaded(*ARGUMENTS[0])
    np.testing.assert_array_equal(found["y"], [0, 2, 4])
    assert float(found["sum"]) == 3
    assert store.load("another", ARGUMENTS) is None


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: content[:-1],
        lambda _: b"",
        lambda content: content[:99] + bytes([content[99] ^ 1]) + content[100:],
        lambda _: pickle.dumps("foreign"),
    ],
    ids=["truncated", "empty", "one bit", "foreign"],
)
def test_a_damaged_file_is_as_good_as_none(store, executable, damage):
    store.save("name", executable)
    file = file_in(store)
    file.write_bytes(damage(file.read_bytes()))
    assert store.load("name", ARGUMENTS) is None
    store.save("name", executable)
    assert store.load("name", ARGUMENTS) is not None


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o720])
def test_a_folder_that_others_can_write_to_is_not_used(store, executable, mode):
    store.save("name", executable)
    store.folder.chmod(mode)
    assert store.load("name", ARGUMENTS) is None
    store.save("another", executable)
    assert file_in(store).name == "name", "nothing is added"
    store.folder.chmod(0o700)
    assert store.load("name", ARGUMENTS) is not None


def test_a_folder_of_another_user_is_not_used(store, executable, monkeypatch):
    store.save("name", executable)
    other = os.getuid() + 1
    monkeypatch.setattr(os, "getuid", lambda: other)
    assert store.load("name", ARGUMENTS) is None
    store.save("another", executable)
    assert file_in(store).name == "name", "nothing is added"


def test_the_folder_is_closed_to_others_whatever_is_usual(tmp_path, executable):
    before = os.umask(0)
    try:
        store = Executables(tmp_path / "kept", LIMIT)
        store.save("name", executable)
    finally:
        os.umask(before)
    assert store.load("name", ARGUMENTS) is not None


def test_a_folder_that_cannot_be_made_only_costs_time(tmp_path, executable):
    (tmp_path / "taken").touch()
    store = Executables(tmp_path / "taken" / "below", LIMIT)
    store.save("name", executable)
    assert store.load("name", ARGUMENTS) is None


def test_what_was_not_used_for_longest_goes_first(tmp_path, executable):
    store = Executables(tmp_path, LIMIT)
    store.save("first", executable)
    size = file_in(store).stat().st_size
    store.limit = 2 * size + size // 2
    store.save("second", executable)
    for name, age in (("first", 20), ("second", 10)):
        used = time.time() - age
        os.utime(tmp_path / name, (used, used))
    assert store.load("first", ARGUMENTS) is not None
    store.save("third", executable)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["first", "third"]
