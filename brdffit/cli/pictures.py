"""Pictures of a fit or a comparison, written into a folder."""

from collections.abc import Callable
from pathlib import Path

from brdffit.fit import FitResult
from brdffit.fit.select import Comparison
from brdffit.plots import album, save
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
