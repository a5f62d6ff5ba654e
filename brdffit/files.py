"""Files are whole or absent when written, and hold what they claim when read.

They are written under a temporary name, then renamed.
"""

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

SMALL = 50_000_000  # bytes of pixels that any file may unpack to
MOST_PACKED = 50  # bytes of pixels for each byte of a larger file


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


def refuse_bomb(path: Path, numbers: int, small: int = SMALL) -> None:
    """Refuse a large image that its header makes, not its content.

    Pixels of photographs and renders pack to a tenth, not to a hundredth.

    Args:
        path: The file, or a folder of them.
        numbers: How many numbers of four bytes it is said to hold.
        small: Bytes that are let through whatever the file holds.

    Raises:
        ValueError: They are more than 50 times what is in the file.
    """
    files = path.iterdir() if path.is_dir() else [path]
    size = sum(file.stat().st_size for file in files if file.is_file())
    if 4 * numbers > max(small, MOST_PACKED * size):
        raise ValueError(
            f"`{path}` claims {numbers} numbers, {4 * numbers // max(size, 1)} times "
            "what is in it; it is damaged or empty of content."
        )
