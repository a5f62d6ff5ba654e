"""Pictures and the report of a fit or a comparison, written into a folder."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from brdffit.fit import FitResult
from brdffit.fit.select import Comparison
from brdffit.plots import album, save
from brdffit.readers import READERS, format_of
from brdffit.samples import Measurement, Samples


def write_pictures(
    data: Measurement | Samples,
    outcome: FitResult | Comparison,
    folder: Path,
    step: Callable[[str], None],
) -> list[Path]:
    """Write every figure that suits the outcome as PNG and PDF.

    Args:
        data: What was fitted.
        outcome: The fit or comparison.
        folder: Where to write.
        step: Called before each figure.

    Returns:
        The files, in the order in which they were written.

    Raises:
        OSError: A file cannot be written.
    """
    written = []
    step("drawing")
    for name, figure in album(data, outcome):
        written += save(figure, folder, name)
        step("drawing")
    return written


def write_report(
    outcome: FitResult | Comparison,
    data: Measurement | Samples,
    source: Path,
    folder: Path | None,
    changed: bool,
) -> Path:
    """Write ``report.html``.

    Args:
        outcome: The fit or comparison.
        data: What was fitted.
        source: File or folder that the data were read from.
        folder: Where to write; by default the current folder.
        changed: Whether other channels were fitted than the source has.

    Returns:
        The file.

    Raises:
        OSError: The file cannot be written.
    """
    from brdffit.report import report

    reader = READERS[format_of(source)]
    anywhere = None if changed else getattr(reader, "evaluate", None)
    evaluate = anywhere and partial(anywhere, source)
    path = (folder or Path()) / "report.html"
    return report(outcome, data, path, source=source, evaluate=evaluate)
