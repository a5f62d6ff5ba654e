"""Where tests find measured data that is not part of the repository."""

import os
from pathlib import Path

import pytest

BESIDE = Path(__file__).parents[1].parent / "shared" / "data"


def shared_data(*parts: str) -> Path:
    """Path of a file below the data folder; skips the test when it is not there.

    The folder is named by the environment variable BRDFFIT_DATA, and is otherwise
    ``../shared/data`` beside the repository.
    """
    path = Path(os.environ.get("BRDFFIT_DATA", BESIDE)).joinpath(*parts)
    if not path.exists():
        pytest.skip(f"{path.name} is not here: set BRDFFIT_DATA to the data folder")
    return path
