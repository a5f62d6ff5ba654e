"""What a user sees: text or JSON on standard output, progress on a terminal."""

import contextlib
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

from brdffit.batch.tally import Tally

WIDE = 200  # columns when the output is not a terminal


def output() -> "Console":
    """Standard output, for tables and sentences that are shown as they are."""
    from rich.console import Console

    return Console(
        width=None if sys.stdout.isatty() else WIDE,
        markup=False,
        highlight=False,
        emoji=False,
    )


def print_line(sentence: str = "") -> None:
    """One sentence on standard output, in several lines on a terminal only."""
    console = output()
    console.print(sentence, soft_wrap=not console.is_terminal)


def print_written(written: Sequence[Path]) -> None:
    """The folder and the files in it, if any."""
    if written:
        names = ", ".join(path.name for path in written)
        print_line(f"Written to {written[0].parent.resolve()}: {names}.")


def print_json(content: Mapping[str, Any]) -> None:
    """Write a mapping as JSON to standard output, where nothing else is written."""
    sys.stdout.write(json.dumps(content, indent=2, allow_nan=False) + "\n")


@contextlib.contextmanager
def progress(total: int) -> Iterator[Callable[[str], None]]:
    """A bar on a terminal, nothing elsewhere.

    Args:
        total: Number of steps.

    Yields:
        A function to call before each step, with a word for what it does.
    """
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich import progress as rich
    from rich.console import Console

    bar = rich.Progress(
        rich.SpinnerColumn(),
        rich.TextColumn("{task.description}", markup=False),
        rich.BarColumn(),
        rich.MofNCompleteColumn(),
        rich.TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
    )
    task = bar.add_task("starting", total=total)
    begun = 0

    def step(description: str) -> None:
        nonlocal begun
        bar.update(task, description=description, completed=begun)
        begun += 1

    with bar:
        yield step


@contextlib.contextmanager
def transfer(name: str) -> Iterator[Callable[[int, int | None], None]]:
    """A bar of bytes on a terminal, nothing elsewhere.

    Args:
        name: What is transferred.

    Yields:
        A function to call with the bytes that are there and the number of all.
    """
    if not sys.stderr.isatty():
        yield lambda *_: None
        return
    from rich import progress as rich
    from rich.console import Console

    bar = rich.Progress(
        rich.TextColumn("{task.description}", markup=False),
        rich.BarColumn(),
        rich.DownloadColumn(),
        rich.TransferSpeedColumn(),
        rich.TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )
    task = bar.add_task(name, total=None)
    with bar:
        yield lambda done, total: bar.update(task, completed=done, total=total)


@contextlib.contextmanager
def tally_bar() -> Iterator[Callable[[Tally], None]]:
    """A bar of the texels or fits of a long run on a terminal, nothing elsewhere.

    It shows the share done, the rate and the time left of this run, in which what an
    earlier run finished does not count, and how many did not converge.

    Yields:
        A function to call with the counts of the run.
    """
    from rich import progress as rich
    from rich.console import Console

    bar = rich.Progress(
        rich.SpinnerColumn(),
        rich.TextColumn("{task.description}", markup=False),
        rich.BarColumn(),
        rich.TaskProgressColumn(),
        rich.TextColumn("{task.fields[pace]}", markup=False),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )
    task = bar.add_task("starting", total=None, pace="")

    def show(tally: Tally) -> None:
        finished = tally.kept + tally.done
        bar.update(
            task,
            description=f"{finished:,} of {tally.total:,} {tally.unit}",
            completed=finished,
            total=tally.total,
            pace=pace(tally),
        )

    with bar:
        yield show


def pace(tally: Tally) -> str:
    """Rate, time left and failures of a run, in few words."""
    parts = []
    if tally.remaining is not None:
        left = timedelta(seconds=round(tally.remaining))
        parts += [f"{tally.rate:,.3g}/s", f"{left} left"]
    if tally.not_converged:
        parts.append(f"{tally.not_converged:,} not converged")
    if tally.failed:
        parts.append(f"{tally.failed:,} failed")
    return ", ".join(parts)
