"""The text of a scene, refused where reading it would take long or much memory."""

import re
import tomllib
from pathlib import Path
from typing import Any

LARGEST = 4_000_000  # bytes of a scene
DEEP = re.compile(r"""(?<![\w"'-])(?:[\w"'-]+\s*\.\s*){20}""")  # a key of keys of keys


def load_toml(path: str | Path) -> dict[str, Any]:
    """A TOML file as nested dictionaries.

    Raises:
        OSError: The file cannot be read.
        ValueError: The file is not TOML, or larger or deeper than a scene can be.
    """
    try:
        if Path(path).stat().st_size > LARGEST:
            raise ValueError(f"it is larger than {LARGEST} bytes")
        text = Path(path).read_text(encoding="utf-8")
        if DEEP.search(text):
            raise RecursionError
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError(f"Scene `{path}` is nested too deep to be a scene.") from None
    except OSError as error:
        raise OSError(f"Scene `{path}` cannot be read: {error.strerror}.") from error
    except ValueError as error:  # of TOML and of its encoding
        raise ValueError(f"Scene `{path}` is not TOML: {error}.") from error
