"""Angles of files as unit vectors, in numpy and in the precision of the file."""

import numpy as np


def directions(theta: np.ndarray | float, phi: np.ndarray | float) -> np.ndarray:
    """Unit vectors ``(..., 3)`` with polar angle ``theta``, azimuth ``phi`` (radians).

    Both broadcast. A negative polar angle leans the other way, as goniometers write it.
    NaN where an angle is not finite.
    """
    theta, phi = np.broadcast_arrays(finite(theta), finite(phi))
    sin_theta = np.sin(theta)
    return np.stack(
        [sin_theta * np.cos(phi), sin_theta * np.sin(phi), np.cos(theta)], axis=-1
    )


def finite(angles: np.ndarray | float) -> np.ndarray:
    """Angles, and NaN for infinite ones, whose sine numpy would warn of."""
    return np.where(np.isfinite(angles), angles, np.nan)
