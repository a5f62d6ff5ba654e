"""Which numbers of a file may be used; the last step of every reader.

The reader keeps every number of its file. What cannot be a reflectance is masked: NaN
and infinity, negative values, and directions at or below the horizon.
"""

from pathlib import Path
from typing import Any

import numpy as np

from brdffit.samples import Measurement

HORIZON = 1e-6  # cosine; 90 degrees is 6e-17 after rounding, and is at the horizon


def measurement(
    path: Path | str,
    wi: np.ndarray,
    wo: np.ndarray,
    f_r: np.ndarray,
    known: np.ndarray | None = None,
    **details: Any,
) -> Measurement:
    """A measurement whose mask is False where a value must not be used.

    Args:
        path: File that the numbers come from, for the error.
        wi: Directions to the light ``(N, 3)``.
        wo: Directions to the viewer ``(N, 3)``.
        f_r: Reflectance ``(N, C)``.
        known: False where the file itself says that it has no data, ``(N, C)``.
        details: Other fields of `Measurement`.

    Raises:
        ValueError: No value can be used.
    """
    mask = np.isfinite(f_r) & (f_r >= 0)
    mask &= ((wi[:, 2] > HORIZON) & (wo[:, 2] > HORIZON))[:, None]
    if known is not None:
        mask &= known
    if not mask.any():
        raise ValueError(
            f"File `{path}` holds no reflectance that can be used: all of its "
            f"{mask.size} values are missing, not finite, negative or below the "
            f"horizon."
        )
    return Measurement(wi=wi, wo=wo, f_r=f_r, mask=mask, **details)
