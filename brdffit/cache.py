"""The compilation cache: programs that JAX has compiled, kept for the next process.

Most of the time of a small fit goes into tracing and compiling it; with the cache that
is paid once for each model and kind of data. The programs of a fit are kept whole, see
`brdffit.executables`, so that they need not even be traced; all others in JAX's own
cache, which saves their compilation.
"""

import contextlib
import os
from pathlib import Path

import jax
import platformdirs
from jax.experimental.compilation_cache import compilation_cache

from brdffit import executables
from brdffit.files import require_writable

VARIABLE = "BRDFFIT_CACHE"
OFF = "off"
LIMIT = 512 * 1024**2  # bytes; the programs that were not used for longest go first
SHARE = LIMIT // 2  # of it for programs that are kept whole


def enable_compilation_cache(folder: str | Path | None = None) -> Path | None:
    """Keep compiled programs on disk and look for them there, from now on.

    Only a folder that belongs to the user and that nobody else may write to is safe:
    what is found there is run.

    Args:
        folder: Where to keep them. By default the folder that the environment variable
            BRDFFIT_CACHE names, then the one that JAX has been told to use, then the
            folder for caches of the operating system. With BRDFFIT_CACHE=off nothing is
            kept.

    Returns:
        The folder, or None when nothing is kept: because it was switched off, or
        because the folder cannot be written, which only costs time.
    """
    chosen = folder or os.environ.get(VARIABLE)
    if chosen == OFF:
        return None
    told = jax.config.jax_compilation_cache_dir  # pyright: ignore  (added at run time)
    path = Path(chosen or told or platformdirs.user_cache_path("brdffit") / "jax")
    with contextlib.suppress(OSError):
        require_writable(path)
        jax.config.update("jax_compilation_cache_dir", str(path))
        jax.config.update("jax_compilation_cache_max_size", LIMIT - SHARE)
        # by default JAX keeps only what took long to compile
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0)
        jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)
        compilation_cache.reset_cache()  # forget the one that was used before
        executables.keep(path / "executables", SHARE)
        return path
    return None
