"""Files are whole or absent: written under a temporary name, then renamed."""

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """A temporary path beside ``path`` that takes its place when the block succeeds.

    The temporary name keeps the suffix, by which many libraries choose a format. When
    the block fails, ``path`` is as it was before.

    Raises:
        OSError: The file cannot be written; the message names it and says why.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        if not path.parent.is_dir():
            raise NotADirectoryError(20, f"`{path.parent}` is not a folder")
        yield temporary
        temporary.replace(path)
    except OSError as error:
        reason = error.strerror or error
        raise OSError(f"File `{path}` cannot be written: {reason}.") from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()


def require_writable(folder: str | Path) -> None:
    """Make sure that files can be written into a folder, before long work.

    The folder need not exist yet, and nothing is left behind.

    Raises:
        OSError: It cannot be written, or not be made; the message says why.
    """
    folder = Path(folder)
    existing = next(p for p in [folder, *folder.absolute().parents] if p.exists())
    reason = f"`{existing}` is not a folder"
    if existing.is_dir():
        try:
            with tempfile.TemporaryFile(dir=existing):
                return
        except OSError as error:
            reason = f"`{existing}` takes no new files ({error.strerror or error})"
    raise OSError(f"Folder `{folder}` cannot be written: {reason}.")


def sentence(error: Exception) -> str:
    """What an error says; one of the operating system names its file and the reason."""
    if isinstance(error, OSError) and error.filename is not None:
        return f"File `{error.filename}` cannot be used: {error.strerror}."
    return str(error)
