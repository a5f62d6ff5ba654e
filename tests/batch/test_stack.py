"""Texels go to disk and back unchanged, and what is no stack is told."""

import pickle

import numpy as np
import pytest

from brdffit.batch.stack import TexelStack, ZarrStack, arrays_of, save_stack
from brdffit.batch.texture import content_of, import_zarr
from tests.batch.wall import CHUNK, texels


def test_a_stack_reads_what_was_saved_wherever_it_is_opened(tmp_path):
    parts = [texels(CHUNK, 0), texels(CHUNK, 1), texels(10, 2)]
    stack = save_stack(tmp_path / "wall.zarr", parts, (6, 87))
    again = pickle.loads(pickle.dumps(stack))
    assert (again.texels, again.channels, again.shape) == (2 * CHUNK + 10, 3, (6, 87))
    assert len(pickle.dumps(again)) < 1000
    across = again.read(CHUNK - 5, CHUNK + 5)
    for name, array in arrays_of(across).items():
        first, second = (getattr(part, name) for part in parts[:2])
        if first.shape[-1] == 1:
            np.testing.assert_array_equal(array, first)
        else:
            np.testing.assert_array_equal(array[..., :5], first[..., -5:])
            np.testing.assert_array_equal(array[..., 5:], second[..., :5])
    with pytest.raises(FileExistsError, match="exists"):
        save_stack(tmp_path / "wall.zarr", parts)


def test_texels_in_memory_are_a_stack_too(tmp_path):
    whole = texels(CHUNK)
    kept = save_stack(tmp_path / "wall.zarr", [whole]).read(7, 90)
    assert content_of(TexelStack(whole).read(7, 90)) == content_of(kept)


def test_content_is_in_every_number_and_shape():
    one, other = texels(8), texels(8)
    assert content_of(one) == content_of(other)
    other.value[3, 1, 2] = np.nextafter(other.value[3, 1, 2], 1)
    assert content_of(one) != content_of(other)


def test_a_path_that_is_no_stack_is_told(tmp_path):
    with pytest.raises(ValueError, match="must be a zarr group"):
        ZarrStack(tmp_path)
    group = import_zarr().create_group(tmp_path / "other.zarr")
    group.create_array("value", data=np.zeros((2, 3, 4), np.float32))
    with pytest.raises(ValueError, match="lacks wi, wo, weight"):
        ZarrStack(tmp_path / "other.zarr")
