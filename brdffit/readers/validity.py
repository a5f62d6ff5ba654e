"""Which numbers of a file may be used; the last step of every reader.

The reader keeps every value of its file. What cannot be used is masked: NaN and
infinity, directions at or below the horizon, and, where the number is a reflectance and
not a radiance with noise, negative values. A direction that is not finite is masked and
becomes the normal, because no BRDF can be evaluated there.
"""

from pathlib import Path
from typing import Any

import numpy as np

from brdffit.samples import Measurement
from brdffit.types import Mask, Values, Vectors

NORMAL = np.array([0.0, 0.0, 1.0])
SMALL = 5_000_000  # bytes of pixels that any image of a surface may unpack to
HORIZON = 1e-6  # cosine; 90 degrees is 6e-17 after rounding, and is at the horizon


def require_size(path: Path, expected: int, kind: str) -> None:
    """Refuse a file of a format whose files all have the same size.

    Raises:
        ValueError: The file has another size.
        OSError: The file cannot be read.
    """
    size = path.stat().st_size
    if size != expected:
        raise ValueError(
            f"{kind} file `{path}` must have {expected} bytes, but has {size}; it is "
            f"{'cut off' if size < expected else 'of another kind'}."
        )


def measurement(
    path: Path | str,
    wi: Vectors,
    wo: Vectors,
    f_r: Values,
    known: Mask | None = None,
    **details: Any,
) -> Measurement:
    """A measurement whose mask is False where a value must not be used.

    Args:
        path: File that the numbers come from, for the error.
        wi: Directions to the light.
        wo: Directions to the viewer.
        f_r: Reflectance.
        known: False where the file itself says that it has no data.
        details: Other fields of `Measurement`.

    Raises:
        ValueError: No value can be used.
    """
    finite = np.isfinite(wi).all(axis=1, keepdims=True)
    finite = finite & np.isfinite(wo).all(axis=1, keepdims=True)
    if not finite.all():
        wi = np.where(finite, wi, NORMAL).astype(wi.dtype)
        wo = np.where(finite, wo, NORMAL).astype(wo.dtype)
    mask = np.isfinite(f_r) & (f_r >= 0) & finite
    mask &= (above_horizon(wi) & above_horizon(wo))[:, None]
    if known is not None:
        mask &= known
    refuse_unusable(path, mask)
    return Measurement(wi=wi, wo=wo, f_r=f_r, mask=mask, **details)


def above_horizon(w: Vectors) -> np.ndarray:
    """Whether directions ``(..., 3)`` lie above the horizon, by more than rounding."""
    return np.asarray(w[..., 2] > HORIZON)


def refuse_unusable(path: Path | str, mask: Mask) -> None:
    """Refuse a file all of whose values are masked."""
    if not mask.any():
        raise ValueError(
            f"`{path}` holds no value that can be used: all {mask.size} are missing, "
            f"not finite, negative, saturated, or have a direction below the horizon."
        )
