"""The points at which a material of the RGL database was measured.

They are the nodes of the table of reflectance, for each direction of incidence, taken
through the warp to half vectors, about which the light is mirrored to the viewer.
"""

import numpy as np
from jaxtyping import Float

from brdffit.readers.adaptive_warp import Slices
from brdffit.readers.angles import directions
from brdffit.readers.rgl_material import Material, square
from brdffit.readers.validity import HORIZON
from brdffit.types import Values, Vectors


@np.errstate(all="ignore")  # what is not finite is masked later
def nodes(
    material: Material,
) -> tuple[Vectors, Vectors, Values, Float[np.ndarray, " node"]]:
    """Directions ``wi`` and ``wo``, ``f_r`` and solid angle about ``wo`` of all nodes.

    Values keep the single precision of the file.
    """
    grid = (material.reflectance.rows, material.reflectance.columns)
    uniform = lattice(*(np.linspace(0, 1, count) for count in grid))
    incidence = lattice(material.phi_i, material.theta_i)
    shape = (len(incidence), len(uniform))
    wi, wo = np.empty((2, *shape, 3))
    f_r = np.empty((*shape, len(material.channels)), np.float32)
    size = np.empty(shape)
    for index, (theta_i, phi_i) in enumerate(incidence):
        wi[index] = directions(theta_i, phi_i)
        u_h = material.warp.sample(uniform, index)
        wo[index], _ = mirrored(material, u_h, wi[index, 0], phi_i)
        u_i = np.broadcast_to(square(theta_i, phi_i), u_h.shape)
        value = material.reflectance.values[index].T * material.scale(u_i, u_h)
        f_r[index] = value / np.maximum(wo[index, :, 2:], HORIZON)
        size[index] = solid_angles(material, grid, wi[index, 0], phi_i, index)
    return (
        wi.reshape(-1, 3),
        wo.reshape(-1, 3),
        f_r.reshape(-1, len(material.channels)),
        size.reshape(-1),
    )


def mirrored(
    material: Material, u_h: np.ndarray, wi: np.ndarray, phi_i: float
) -> tuple[Vectors, np.ndarray]:
    """Light mirrored at half vectors, and solid angle per unit of the square."""
    theta_h, phi_h = u_h[:, 0] ** 2 * np.pi / 2, (2 * u_h[:, 1] - 1) * np.pi
    half = directions(theta_h, phi_h + phi_i if material.isotropic else phi_h)
    cos_d = half @ wi
    of_half = 2 * np.pi**2 * u_h[:, 0] * np.sin(theta_h)
    return 2 * cos_d[:, None] * half - wi, of_half * 4 * np.abs(cos_d)


def solid_angles(
    material: Material, grid: tuple[int, int], wi: np.ndarray, phi_i: float, index: int
) -> np.ndarray:
    """What each node of a slice stands for above the horizon, in sr.

    That is the four quarters of patches around it, each measured at its centre, because
    the density of the warp may vanish at the nodes themselves.
    """
    rows, columns = grid
    quarters = lattice(midpoints(2 * (rows - 1)), midpoints(2 * (columns - 1)))
    u_h = material.warp.sample(quarters, index)
    wo, stretch = mirrored(material, u_h, wi, phi_i)
    slices: Slices = np.full((1, 1), index), np.ones((1, 1))
    density = material.warp(u_h, slices)[:, 0]
    density *= (material.warp.rows - 1) * (material.warp.columns - 1)
    size = np.where(wo[:, 2] > 0, stretch / density / len(quarters), 0)
    framed = np.pad(size.reshape(2 * (rows - 1), 2 * (columns - 1)), 1)
    return framed.reshape(rows, 2, columns, 2).sum(axis=(1, 3)).ravel()


def lattice(rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """All pairs ``(column, row)``, row by row."""
    y, x = np.meshgrid(rows, columns, indexing="ij")
    return np.stack([x.ravel(), y.ravel()], axis=1)


def midpoints(count: int) -> np.ndarray:
    """Centres of equal parts of [0, 1]."""
    return (np.arange(count) + 0.5) / count
