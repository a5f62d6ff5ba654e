"""Executables, kept on disk: programs that a later process need not even trace.

What is kept is loaded as code. So the folder must belong to the user and must not be
writable by anyone else; where it does, or where the system cannot tell, nothing is kept
in it and nothing loaded from it.
"""

import contextlib
import hashlib
import os
import pickle
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jax
from jax.experimental.compilation_cache import compilation_cache
from jax.experimental.serialize_executable import deserialize_and_load, serialize

from brdffit.files import replacing

DIGEST = hashlib.sha256().digest_size


class Executables:
    """A folder of executables, each under the name of what it depends on.

    Safe when several processes use it: a file is written under another name first, and
    one that is lost, damaged or cannot be loaded here is as good as none.
    """

    def __init__(self, folder: Path, limit: int) -> None:
        """Keep executables in a folder that need not exist yet.

        Args:
            folder: Where they are.
            limit: Bytes; those that were not used for longest go first.
        """
        self.folder, self.limit = folder, limit

    def load(self, name: str, arguments: Any) -> jax.stages.Compiled | None:
        """The executable of a name, or None without one.

        Args:
            name: Name of the program.
            arguments: Arguments and named arguments, in a tuple.
        """
        if not self._safe():
            return None
        path = self.folder / name
        try:
            content = path.read_bytes()
            if hashlib.sha256(content[DIGEST:]).digest() != content[:DIGEST]:
                return None
            program, results = pickle.loads(content[DIGEST:])
            loaded = deserialize_and_load(
                program,
                jax.tree.structure(arguments),
                jax.tree.structure(results),
                execution_devices=jax.devices()[:1],
            )
            os.utime(path)
        except Exception:  # of any kind, by what a later library makes of the file
            return None
        return loaded

    def save(self, name: str, executable: jax.stages.Compiled) -> None:
        """Keep an executable, if that is possible.

        It must have been compiled `without_cache`: one that was loaded itself lacks
        what it needs to be loaded again.
        """
        with contextlib.suppress(OSError):
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not self._safe():
            return
        try:
            program, _, tree = serialize(executable)
        except (NotImplementedError, ValueError, jax.errors.JaxRuntimeError):
            return
        # modules are pickled as such: their tree structures cannot be
        results = jax.tree.unflatten(tree, range(tree.num_leaves))
        content = pickle.dumps((program, results))
        with contextlib.suppress(OSError):
            with replacing(self.folder / name) as temporary:
                temporary.write_bytes(hashlib.sha256(content).digest() + content)
            self._make_room()

    def _safe(self) -> bool:
        """Whether nobody else can put anything into the folder."""
        try:
            state = self.folder.stat()
            return state.st_uid == os.getuid() and not state.st_mode & (
                stat.S_IWGRP | stat.S_IWOTH
            )
        except (OSError, AttributeError):
            return False

    def _make_room(self) -> None:
        """Drop what was not used for longest, until the limit is kept."""
        states = {path: path.stat() for path in self.folder.iterdir()}
        size = sum(state.st_size for state in states.values())
        for path in sorted(states, key=lambda path: states[path].st_mtime):
            if size <= self.limit:
                break
            size -= states[path].st_size
            path.unlink(missing_ok=True)


@contextlib.contextmanager
def without_cache() -> Iterator[None]:
    """Let JAX compile what is compiled meanwhile, not look it up in its own cache."""
    before = jax.config.jax_enable_compilation_cache  # pyright: ignore  (as in cache)
    try:
        jax.config.update("jax_enable_compilation_cache", False)
        compilation_cache.reset_cache()
        yield
    finally:
        jax.config.update("jax_enable_compilation_cache", before)
        compilation_cache.reset_cache()


store: Executables | None = None
"""Where this process keeps executables; None until it is told to."""


def keep(folder: Path, limit: int) -> None:
    """Keep executables in a folder from now on; see `Executables`."""
    global store
    store = Executables(folder, limit)
