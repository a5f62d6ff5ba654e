"""The ledger of a folder: what is finished, out of what it came, and its checksum.

A task writes its files, each under a temporary name that is then renamed, waits until
the disk has them, and returns a `Record`. The run appends the record as one line to
``ledger.jsonl``. Nothing counts as finished without its line, and no line counts whose
files have another checksum now; so whatever was half-written when a run died is done
again, and nothing else.
"""

import contextlib
import dataclasses
import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from brdffit.files import replacing, require_writable

WAITING = 8  # files that are waited for at the same time
LEDGER = "ledger.jsonl"
LOCK = ".lock"


@dataclasses.dataclass(frozen=True)
class Record:
    """One finished task.

    Attributes:
        key: Which task of its folder.
        fingerprint: Of input, model, options and version; see `fingerprint`.
        checksum: Of the files that it wrote; see `seal`.
        facts: What a run counts, so that it need not open those files again.
    """

    key: str
    fingerprint: str
    checksum: str
    facts: Mapping[str, Any] = dataclasses.field(default_factory=dict)

    def holds(self, fingerprint: str, files: Iterable[Path]) -> bool:
        """Whether the task is still the same, and its files are what it wrote."""
        if self.fingerprint != fingerprint:
            return False
        try:
            return self.checksum == seal(files)
        except OSError:
            return False


def fingerprint(**what: Any) -> str:
    """A hash of everything that decides what a task writes, version included.

    Args:
        what: In types that JSON knows; what is large as a hash of its content.
    """
    text = json.dumps(what | {"brdffit": version("brdffit")}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def seal(files: Iterable[Path]) -> str:
    """Wait until the disk has the files and their names; returns their checksum.

    Raises:
        OSError: One of them cannot be read, or not be kept.
    """
    files = list(files)
    with ThreadPoolExecutor(WAITING) as pool:  # a disk takes many at once as one
        parts = list(pool.map(_settled, files))
        list(pool.map(_settle, {path.parent for path in files}))
    return hashlib.sha256(b"".join(parts)).hexdigest()


def _settled(file: Path) -> bytes:
    """The checksum of a file that the disk has."""
    with file.open("rb") as stream:
        os.fsync(stream.fileno())
        return hashlib.file_digest(stream, "sha256").digest()


def _settle(folder: Path) -> None:
    """Wait until the disk has the names in a folder, where the system can do that."""
    with contextlib.suppress(PermissionError):  # Windows opens no folders
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


class Ledger:
    """The records of a folder, by key; opened by `open_ledger` only."""

    def __init__(self, path: Path) -> None:
        """Read what is there; a line that was cut off is none."""
        self.path = path
        self.records: dict[str, Record] = {}
        for line in path.read_text().splitlines() if path.exists() else ():
            with contextlib.suppress(ValueError, TypeError):
                record = Record(**json.loads(line))
                self.records[record.key] = record
        with replacing(path) as temporary:
            temporary.write_text("".join(map(_line, self.records.values())))
            seal([temporary])

    def commit(self, record: Record) -> None:
        """Append a record.

        Raises:
            OSError: The disk does not take it.
        """
        with self.path.open("a") as stream:
            stream.write(_line(record))
            stream.flush()
            os.fsync(stream.fileno())
        self.records[record.key] = record


def _line(record: Record) -> str:
    return json.dumps(dataclasses.asdict(record)) + "\n"


@contextlib.contextmanager
def open_ledger(folder: Path, resume: bool) -> Iterator[Ledger]:
    """The ledger of a folder, which no other run can open meanwhile.

    Args:
        folder: Made if it is not there.
        resume: Whether to go on with what it holds.

    Raises:
        FileExistsError: The folder holds something and is not to be resumed, or holds
            something that no run left there.
        BlockingIOError: Another run has it.
        OSError: The folder cannot be written.
    """
    require_writable(folder)
    ours = (folder / LOCK).exists()
    if folder.exists() and any(folder.iterdir()) and not ours:
        raise FileExistsError(
            f"Folder `{folder}` holds other files: name a new or an empty one."
        )
    folder.mkdir(parents=True, exist_ok=True)
    lock = FileLock(folder / LOCK)
    try:
        lock.acquire(blocking=False)
    except Timeout:
        raise BlockingIOError(
            f"Folder `{folder}` is being written by another run: wait until it ends, "
            "or name another folder."
        ) from None
    try:
        if not resume and any(path.name != LOCK for path in folder.iterdir()):
            raise FileExistsError(
                f"Folder `{folder}` holds an earlier run: go on with it by --resume "
                "(in Python, resume=True), or name another folder."
            )
        yield Ledger(folder / LEDGER)
    finally:
        lock.release()
