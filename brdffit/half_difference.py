r"""The grid of half and difference angles that MERL files use, as pairs of directions.

For an isotropic surface a pair of directions is given by the polar angle $\theta_h$ of
the half vector and by the light in a frame about it: polar angle $\theta_d$ and azimuth
$\phi_d$, which reciprocity confines to [0, pi). The cells are equal in $\theta_d$ and
$\phi_d$, and equal in the square root of $\theta_h$, finest at the highlight.

Source:
    S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation",
    Eurographics Workshop on Rendering 1998; W. Matusik, H. Pfister, M. Brand,
    L. McMillan, "A Data-Driven Reflectance Model", SIGGRAPH 2003,
    https://doi.org/10.1145/1201775.882343
"""

import numpy as np
from jaxtyping import Float

from brdffit.types import Index, Vectors

SHAPE = (90, 90, 180)  # cells in theta_h, theta_d, phi_d
COUNT = 90 * 90 * 180

Directions = Float[np.ndarray, "cell 3"]


def cells() -> tuple[Directions, Directions, Float[np.ndarray, " cell"]]:
    r"""Directions ``wi`` and ``wo`` at the centre of each cell, and the cell's size.

    The size is the integral of
    $d\omega_i\,d\omega_o = 4\cos\theta_d\,d\omega_h\,d\omega_d$, over all azimuths of
    the half vector and both halves of $\phi_d$: the cells above the horizon sum to
    $(2\pi)^2$. A quarter of all cells lie below it. ``phi_d`` changes fastest, as in
    the file.
    """
    edges = [np.linspace(0, 1, count + 1) for count in SHAPE]
    theta_h, theta_d, phi_d = ((edge[1:] + edge[:-1]) / 2 for edge in edges)
    theta_h, theta_d, phi_d = np.ix_(
        theta_h**2 * (np.pi / 2), theta_d * (np.pi / 2), phi_d * np.pi
    )
    # The light about the half vector, then both tilted with it about the y axis.
    x, y = np.sin(theta_d) * np.cos(phi_d), np.sin(theta_d) * np.sin(phi_d)
    z = np.cos(theta_d)
    cos_h, sin_h = np.cos(theta_h), np.sin(theta_h)
    wi, wo = np.empty((2, *SHAPE, 3))
    for w, sign in ((wi, 1), (wo, -1)):
        w[..., 0] = sign * cos_h * x + sin_h * z
        w[..., 1] = sign * y
        w[..., 2] = cos_h * z - sign * sin_h * x
    size_h = -np.diff(np.cos(edges[0] ** 2 * (np.pi / 2))) * 2 * np.pi
    size_d = np.diff(np.sin(edges[1] * (np.pi / 2)) ** 2) * 2
    size_phi = np.diff(edges[2]) * 2 * np.pi
    size = size_h[:, None, None] * size_d[:, None] * size_phi
    return wi.reshape(-1, 3), wo.reshape(-1, 3), size.reshape(-1)


def cell_of(wi: Vectors, wo: Vectors) -> Index:
    """Place of the cell that each pair of directions falls into, in either order."""
    wi, wo = np.asarray(wi, float), np.asarray(wo, float)
    half = wi + wo
    half = half / np.linalg.norm(half, axis=1, keepdims=True)
    sin_h = np.hypot(half[:, 0], half[:, 1])
    theta_h = np.arctan2(sin_h, half[:, 2])
    cos_phi = np.divide(half[:, 0], sin_h, out=np.ones(len(wi)), where=sin_h > 0)
    sin_phi = np.divide(half[:, 1], sin_h, out=np.zeros(len(wi)), where=sin_h > 0)
    # The light in the frame of the half vector: turned to azimuth 0, then upright.
    along = wi[:, 0] * cos_phi + wi[:, 1] * sin_phi
    y = wi[:, 1] * cos_phi - wi[:, 0] * sin_phi
    x = along * half[:, 2] - wi[:, 2] * sin_h
    theta_d = np.arctan2(np.hypot(x, y), along * sin_h + wi[:, 2] * half[:, 2])
    phi_d = np.arctan2(y, x) % np.pi
    shares = np.sqrt(theta_h * 2 / np.pi), theta_d * 2 / np.pi, phi_d / np.pi
    return np.ravel_multi_index(
        tuple(
            np.clip((share * count).astype(int), 0, count - 1)
            for share, count in zip(shares, SHAPE, strict=True)
        ),
        SHAPE,
    )
