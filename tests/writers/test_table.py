import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from brdffit.readers import table as reader
from brdffit.samples import Measurement
from brdffit.writers import table
from tests.readers.specimens import measurement

FIELDS = ("wi", "wo", "f_r", "sigma", "mask", "solid_angle")


def assert_same(one, other):
    for name in FIELDS:
        mine, its = getattr(one, name), getattr(other, name)
        if mine is not None:
            np.testing.assert_array_equal(np.asarray(mine), its)
            assert np.asarray(mine).dtype == its.dtype


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_everything_comes_back_to_the_last_bit(dtype, tmp_path):
    plain = measurement(channels=4, dtype=dtype)
    whole = dataclasses.replace(
        plain,
        sigma=plain.f_r / 7,
        mask=plain.f_r > 0.5,
        solid_angle=plain.f_r[:, 0] / 3,
        channels=("400 nm", "500 nm", "600 nm", "x"),
        name="a name, with commas: and a colon",
    )
    table.save(whole, tmp_path / "a.csv", comments={"instrument": "none"})
    back = reader.load(tmp_path / "a.csv")
    assert_same(whole, back)
    assert back.channels == whole.channels
    assert back.name == whole.name
    assert "# instrument: none" in (tmp_path / "a.csv").read_text()


def test_digits_survive_a_library_that_changes_how_numpy_prints(tmp_path):
    with np.printoptions(legacy="1.13"):
        table.save(measurement(), tmp_path / "a.csv")
    assert_same(measurement(), reader.load(tmp_path / "a.csv"))


@given(st.lists(st.floats(min_value=0, allow_infinity=False), min_size=1, max_size=5))
@settings(max_examples=25, deadline=None)
def test_any_number_comes_back(tmp_path_factory, numbers):
    up = np.tile([0.0, 0.0, 1.0], (len(numbers), 1))
    one = Measurement(wi=up, wo=up, f_r=np.array(numbers)[:, None])
    path = tmp_path_factory.mktemp("any") / "a.csv"
    table.save(one, path)
    np.testing.assert_array_equal(reader.load(path).f_r, one.f_r)


def test_arrays_of_jax_and_mixed_precision_are_written_exactly(tmp_path):
    up = jnp.array([[0.0, 0.6, 0.8]])
    one = Measurement(wi=up, wo=up, f_r=np.array([[0.1]]))
    table.save(one, tmp_path / "a.csv")
    back = reader.load(tmp_path / "a.csv")
    np.testing.assert_array_equal(back.wi, np.asarray(up, np.float64))
    assert back.f_r[0, 0] == 0.1


@pytest.mark.parametrize(
    "channels", [("a", "a", "b"), ("a,b", "c", "d"), ("wi_x", "b", "c"), ("", "b", "c")]
)
def test_channels_that_could_not_be_read_back_are_refused(channels, tmp_path):
    one = dataclasses.replace(measurement(), channels=channels)
    with pytest.raises(ValueError, match="names of their own"):
        table.save(one, tmp_path / "a.csv")


@pytest.mark.parametrize("comments", [{"a": "b\nc"}, {"a:b": "c"}, {"cosine": "no"}])
def test_comments_that_would_break_the_header_are_refused(comments, tmp_path):
    with pytest.raises(ValueError, match="header"):
        table.save(measurement(), tmp_path / "a.csv", comments)


def test_nothing_is_left_when_writing_fails(tmp_path):
    with pytest.raises(OSError, match="is not a folder"):
        table.save(measurement(), tmp_path / "no" / "a.csv")
    (tmp_path / "folder").mkdir()
    with pytest.raises(OSError, match="Is a directory"):
        table.save(measurement(), tmp_path / "folder")
    assert [p.name for p in tmp_path.rglob("*")] == ["folder"]


def test_a_table_that_exists_survives_a_failure(tmp_path):
    path = tmp_path / "a.csv"
    table.save(measurement(), path)
    before = path.read_bytes()
    with pytest.raises(ValueError, match="header"):
        table.save(measurement(seed=1), path, {"a": "b\nc"})
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
