"""The command line: parse, call, print. One command per file.

Commands import what they compute with when they run, so that help comes at once.
"""

import contextlib
import io
import os
import sys
import warnings
from collections.abc import Sequence

from cyclopts import App, CycloptsError, Parameter

from brdffit.cli.batch import batch
from brdffit.cli.compare import compare
from brdffit.cli.convert import convert
from brdffit.cli.demo import demo
from brdffit.cli.export import export
from brdffit.cli.fetch import fetch
from brdffit.cli.fit import fit
from brdffit.cli.info import info
from brdffit.cli.models import models
from brdffit.cli.plan import plan
from brdffit.cli.render import render
from brdffit.cli.simulate import simulate
from brdffit.cli.svbrdf import svbrdf
from brdffit.files import sentence

DONE, NOT_CONVERGED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


def _version() -> str:
    from importlib.metadata import version

    return version("brdffit")


app = App(
    name="brdffit",
    help="Fit BRDF models to measured reflectance.",
    version=_version,
    help_format="plaintext",
    default_parameter=Parameter(negative=(), show_default=False),
    suppress_keyboard_interrupt=False,
)
COMMANDS = (
    demo,
    models,
    info,
    fit,
    compare,
    batch,
    svbrdf,
    simulate,
    plan,
    render,
    convert,
    export,
    fetch,
)
for command in COMMANDS:
    app.command(command)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: Words; by default those of the shell. The process then ends at once
            when interrupted, as a thread in a compiled program cannot be stopped.

    Returns:
        0 done, 1 did not converge, 2 bad input, for which one sentence stands on
        standard error.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _say
            return _run(arguments)
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except (CycloptsError, ValueError, OSError) as error:
        _say(sentence(error))
        return BAD_INPUT
    except KeyboardInterrupt as stop:
        _say(str(stop) or "Interrupted.")
        if arguments is None:
            sys.stdout.flush()
            os._exit(INTERRUPTED)
        return INTERRUPTED


def _run(arguments: Sequence[str] | None) -> int:
    status = app(
        arguments,
        exit_on_error=False,
        print_error=False,
        result_action="return_value",
    )
    sys.stdout.flush()
    return status or DONE


def _say(words: object, *_: object) -> None:
    """One line on standard error."""
    print(f"brdffit: {' '.join(str(words).split())}", file=sys.stderr)  # noqa: T201
