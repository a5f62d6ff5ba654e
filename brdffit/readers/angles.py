"""Angles of files as unit vectors, in numpy and in double precision."""

import numpy as np


def directions(theta: np.ndarray | float, phi: np.ndarray | float) -> np.ndarray:
    """Unit vectors ``(..., 3)`` with polar angle ``theta``, azimuth ``phi`` (radians).

    Both broadcast. A negative polar angle leans the other way, as goniometers write it.
    NaN where an angle is not finite.
    """
    theta, phi = finite(theta), finite(phi)
    sin_theta = np.sin(theta)
    w = np.empty((*np.broadcast_shapes(theta.shape, phi.shape), 3))
    w[..., 0] = sin_theta * np.cos(phi)
    w[..., 1] = sin_theta * np.sin(phi)
    w[..., 2] = np.cos(theta)
    return w


def finite(angles: np.ndarray | float) -> np.ndarray:
    """Angles, and NaN for infinite ones, whose sine numpy would warn of."""
    return np.where(np.isfinite(angles), angles, np.nan)
