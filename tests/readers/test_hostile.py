"""Damaged files: always a measurement or one sentence, never much memory."""

import random
import re
import tracemalloc

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

import brdffit
from brdffit.readers import READERS
from tests.readers.guard import Guard
from tests.readers.mutants import KINDS, damaged
from tests.readers.specimens import SPECIMENS, files_of
from tests.readers.traps import TRAPS

every_format = pytest.mark.parametrize("name", READERS)
SLOW = "merl"  # 35 MB: damaged on disk in place, and less often


def load_or_refuse(path):
    """The measurement, or None after checking that the refusal is one sentence."""
    try:
        loaded = brdffit.load(path)
    except (ValueError, OSError) as error:
        sentence = str(error)
        assert "\n" not in sentence
        assert sentence.endswith((".", "?"))
        assert path.stem in sentence
        assert len(sentence) < 1000 + len(str(path))
        return None
    assert loaded.mask.any()
    return loaded


@every_format
def test_a_file_cut_anywhere(name, tmp_path):
    path = SPECIMENS[name](tmp_path)
    for file in files_of(path):
        whole = file.read_bytes()
        step = len(whole) // (4 if name == SLOW else 24)
        cuts = {*range(0, len(whole), max(step, 1)), *range(len(whole) - 4, len(whole))}
        for cut in sorted(cuts):
            file.write_bytes(whole[: max(cut, 0)])
            load_or_refuse(path)
        file.write_bytes(whole)
    assert load_or_refuse(path) is not None


@every_format
def test_a_file_with_more_at_its_end(name, tmp_path):
    path = SPECIMENS[name](tmp_path)
    for file in files_of(path):
        with file.open("ab") as stream:
            stream.write(b"\0\xff 1 2 3\nmore\n")
    load_or_refuse(path)


@pytest.mark.parametrize("name", sorted(READERS.keys() - {SLOW}))
@given(data=st.data())
@settings(
    max_examples=25,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_bytes_that_were_changed(name, data, tmp_path_factory):
    path = SPECIMENS[name](tmp_path_factory.mktemp("changed"))
    file = data.draw(st.sampled_from(files_of(path)))
    content = bytearray(file.read_bytes())
    # Half of the damage is done to the header, where it decides most.
    last = data.draw(st.sampled_from([min(300, len(content)), len(content)])) - 1
    for _ in range(data.draw(st.integers(1, 4))):
        position = data.draw(st.integers(0, last))
        content[position] = data.draw(st.sampled_from([*b"09-. \n\0\xff\x7f#e", 200]))
    file.write_bytes(content)
    load_or_refuse(path)


@every_format
def test_a_folder_or_nothing_in_its_place(name, tmp_path):
    path = SPECIMENS[name](tmp_path)
    for file in files_of(path):
        whole = file.read_bytes()
        file.unlink()
        if file != path:
            load_or_refuse(path)
        file.mkdir()
        load_or_refuse(path)
        file.rmdir()
        file.write_bytes(whole)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("zemax", b"ScatterRadial\t3", b"ScatterRadial\t2000000000"),
        ("zemax", b"AngleOfIncidence\t2\n0\t40", b"AngleOfIncidence\t3\n0\t40\t50"),
        ("lighttools", b"ScatterAzimuth 4", b"ScatterAzimuth 4000000000"),
        ("astm", b"NUM_POINTS 4", b"NUM_POINTS 99999999999999999999"),
        ("table", b"# rows: 40", b"# rows: 99999999999"),
        ("fred", b"scale=1", b"scale=1e400"),
        ("fred", b"50\t0", b"1e308\t0"),
        ("rgl", (6).to_bytes(8, "little"), (2**40).to_bytes(8, "little")),
        ("sphere_exr", (11).to_bytes(4, "little"), (200_000).to_bytes(4, "little")),
    ],
)
def test_huge_numbers_take_little_memory(name, old, new, tmp_path):
    path = SPECIMENS[name](tmp_path)
    content = path.read_bytes()
    assert old in content
    path.write_bytes(content.replace(old, new))
    tracemalloc.start()
    try:
        load_or_refuse(path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 60e6


def test_a_line_without_an_end_is_refused(tmp_path):
    path = tmp_path / "long.txt"
    path.write_bytes(b"type bsdf_data\n" + b"1 " * 1_000_000)
    with pytest.raises(ValueError, match="Line 2 .* longer than 1000000 characters"):
        brdffit.load(path)


def number(word):
    try:
        return float(word)
    except ValueError:
        return None


@pytest.mark.parametrize("name", ["fred", "zemax", "lighttools", "astm", "nist_ptfe"])
def test_nan_and_negative_values_are_masked_and_counted(name, tmp_path):
    path = SPECIMENS[name](tmp_path)
    before, text = brdffit.load(path), path.read_text()
    words = text.replace(",", " ").split()
    values = {
        value for value in before.f_r[before.mask] if (before.f_r == value).sum() == 1
    }
    word = next(w for w in words if number(w) in values and text.count(w) == 1)
    for new in ("nan", "-inf", "-0.5"):
        path.write_text(text.replace(word, new))
        after = brdffit.load(path)
        assert before.mask.sum() - after.mask.sum() == 1


@pytest.mark.parametrize("angle", ["nan", "inf", "-inf", "1e400"])
@pytest.mark.parametrize(
    ("name", "old"),
    [
        ("fred", "60\t90\t"),
        ("fred", "\n50\t0\n"),
        ("zemax", "0\t10\t20"),
        ("lighttools", "0 30 60"),
        ("astm", "0.100000"),
        ("nist_ptfe", "80,90"),
        ("table", None),
    ],
)
def test_a_direction_that_is_no_number_is_masked_or_refused(name, old, angle, tmp_path):
    path = SPECIMENS[name](tmp_path)
    text = path.read_text()
    if old is None:
        old = text.splitlines()[-1].partition(",")[0]
    new = re.sub(r"[\d.]+", angle, old, count=1)
    path.write_text(text.replace(old, new))
    loaded = load_or_refuse(path)
    if loaded is not None:
        assert np.isfinite(loaded.wi).all()
        assert np.isfinite(loaded.wo).all()
        assert not loaded.mask.all()


def test_a_measurement_without_any_value_is_refused(tmp_path):
    path = SPECIMENS["merl"](tmp_path)
    stored = np.memmap(path, "<f8", "r+", offset=12)
    stored[:] = -1
    stored.flush()
    with pytest.raises(ValueError, match="holds no value that can be used"):
        brdffit.load(path)


@pytest.fixture(scope="module")
def guard(tmp_path_factory):
    with Guard() as guard:
        for name in ("sphere_exr", "sphere_photos"):  # so that imports are charged here
            guard.read(SPECIMENS[name](tmp_path_factory.mktemp("first")))
        yield guard


def size_of(path):
    return sum(file.stat().st_size for file in files_of(path) if file.is_file())


@every_format
def test_damage_is_told_in_a_sentence_within_memory_and_time(name, guard, tmp_path):
    """A share of what experiments/hostile_input.py does in full."""
    path = SPECIMENS[name](tmp_path)
    size, choice = size_of(path), random.Random(1)
    for file in files_of(path):
        whole = file.read_bytes()
        for kind, damages in KINDS.items():
            listed = damages(whole)
            most = 1 if name == SLOW else 6
            for damage in choice.sample(listed, min(len(listed), most)):
                file.write_bytes(damaged(whole, damage))
                assert not guard.read(path).wrong(size, path.stem), (file.name, kind)
        file.write_bytes(whole)


@pytest.mark.parametrize("trap", TRAPS, ids=lambda trap: trap.__name__)
def test_a_trap_is_no_trap(trap, guard, tmp_path):
    path = trap(tmp_path)
    assert not guard.read(path).wrong(size_of(path), "specimen")
