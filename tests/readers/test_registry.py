import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import brdffit
from brdffit.readers import READERS, format_of, title
from brdffit.samples import Measurement, Samples
from tests.readers.specimens import SPECIMENS

every_format = pytest.mark.parametrize("name", READERS)


def test_every_reader_has_a_specimen_and_every_file_a_line():
    assert SPECIMENS.keys() == READERS.keys()
    for name, reader in READERS.items():
        assert reader.__name__.endswith(f".{name}")


@every_format
def test_content_alone_decides_the_format(name, tmp_path):
    path = SPECIMENS[name](tmp_path)
    assert format_of(path) == name
    if path.is_file() and not path.with_suffix(".toml").exists():
        renamed = path.rename(tmp_path / "no_suffix")
        assert format_of(renamed) == name


@every_format
def test_specimen_is_read_with_directions_values_and_mask(name, tmp_path):
    loaded = brdffit.load(str(SPECIMENS[name](tmp_path)))
    values = loaded.f_r if isinstance(loaded, Measurement) else loaded.value
    count = len(loaded)
    assert isinstance(loaded, Measurement | Samples)
    assert isinstance(values, np.ndarray)
    assert loaded.mask.shape == values.shape == (count, len(loaded.channels))
    assert loaded.mask.any()
    assert np.isfinite(values[loaded.mask]).all()
    np.testing.assert_allclose(np.linalg.norm(loaded.wo, axis=-1), 1, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(loaded.wi, axis=-1), 1, atol=1e-6)
    assert loaded.name


@every_format
def test_missing_file_is_one_sentence(name, tmp_path):
    missing = tmp_path / "nothing"
    for load in (brdffit.load, READERS[name].load):
        with pytest.raises(OSError, match="nothing"):
            load(missing)


def test_unknown_content_lists_what_can_be_read_and_hints_by_the_name(tmp_path):
    path = tmp_path / "odd.bsdf"
    path.write_text("hello")
    with pytest.raises(ValueError, match="is like that of Zemax BSDF text") as error:
        brdffit.load(path)
    for reader in READERS.values():
        assert title(reader) in str(error.value)


def test_empty_file_is_one_sentence(tmp_path):
    path = tmp_path / "empty.csv"
    path.touch()
    with pytest.raises(ValueError, match="is empty"):
        brdffit.load(path)


def test_readers_need_neither_matplotlib_nor_colour():
    code = (
        "import sys, brdffit.readers;"
        "print([m for m in ('matplotlib', 'colour') if m in sys.modules])"
    )
    root = Path(brdffit.__file__).parents[1]
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=root, capture_output=True, text=True
    )
    assert done.stdout.strip() == "[]", done.stderr
