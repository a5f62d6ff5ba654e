r"""Interpolation of measured tables, and the warp of the unit square that they define.

A table holds values at the nodes of a grid over the unit square, and one such grid for
each combination of parameters (azimuth and polar angle of the light, wavelength). It is
interpolated linearly in all of them.

A `Warp` takes a table as a density: it maps uniform points $s$ to points $u$ whose
density is the table, first the row by the marginal distribution, then the column by the
conditional one. Only the inverse is needed to look a direction up.

Source:
    J. Dupuy and W. Jakob, "An Adaptive Parameterization for Efficient Material
    Acquisition and Rendering", SIGGRAPH Asia 2018, section 4 and appendix,
    https://doi.org/10.1145/3272127.3275059
"""

import itertools
import math

import numpy as np
from jaxtyping import Float, Int

Points = Float[np.ndarray, "point 2"]
Numbers = Float[np.ndarray, " point"]
Slices = tuple[Int[np.ndarray, "#point corner"], Float[np.ndarray, "#point corner"]]


class Table:
    """Values on a grid over the unit square for each combination of parameters.

    Attributes:
        values: Shape ``(slice, channel, row * column)``; a slice is one combination of
            parameters.
        rows: Rows of the grid; the second coordinate of a point runs along them.
        columns: Columns of the grid, along the first coordinate.
    """

    def __init__(self, array: np.ndarray, *nodes: np.ndarray, channels: int = 1):
        """``array (parameters..., [channels,] rows, columns)``, nodes of parameters."""
        *_, self.rows, self.columns = array.shape
        self.nodes = [np.asarray(node, np.float64) for node in nodes]
        slices = math.prod(len(node) for node in nodes)
        self.values = array.reshape(slices, channels, -1)

    def slices(self, *parameters: Numbers) -> Slices:
        """The slices around each point of parameters, and their weights."""
        count = len(parameters[0]) if parameters else 1
        index, weight = np.zeros((count, 1), int), np.ones((count, 1))
        for nodes, parameter in zip(self.nodes, parameters, strict=True):
            last = len(nodes) - 1
            left = np.searchsorted(nodes, parameter, side="right") - 1
            left = np.clip(left, 0, max(last - 1, 0))
            right = np.minimum(left + 1, last)
            step = np.where(right > left, nodes[right] - nodes[left], 1.0)
            part = np.clip((parameter - nodes[left]) / step, 0, 1)
            index = index[:, :, None] * len(nodes) + np.stack([left, right], 1)[:, None]
            weight = weight[:, :, None] * np.stack([1 - part, part], 1)[:, None]
            index, weight = index.reshape(count, -1), weight.reshape(count, -1)
        return index, weight

    def patch(self, points: Points) -> tuple[np.ndarray, np.ndarray, Numbers, Numbers]:
        """Column and row of the patch that each point lies in, and where within it."""
        x, y = points[:, 0] * (self.columns - 1), points[:, 1] * (self.rows - 1)
        column = np.clip(x.astype(int), 0, self.columns - 2)
        row = np.clip(y.astype(int), 0, self.rows - 2)
        return column, row, x - column, y - row

    def __call__(
        self, points: Points, slices: Slices
    ) -> Float[np.ndarray, "point channel"]:
        """Values at points of the square."""
        column, row, x, y = self.patch(points)
        total = np.zeros((len(points), self.values.shape[1]))
        for down, right in itertools.product((0, 1), repeat=2):
            node = (row + down) * self.columns + column + right
            share = np.where(right, x, 1 - x) * np.where(down, y, 1 - y)
            total += share[:, None] * blend(self.values, slices, node)
        return total


class Warp(Table):
    """A table as a density on the unit square, each slice with integral 1."""

    @np.errstate(all="ignore")  # what is not finite is refused
    def __init__(self, array: np.ndarray, *nodes: np.ndarray):
        """Work out the distributions of rows, and of columns within rows.

        Raises:
            ValueError: A slice is negative or has no positive sum.
        """
        super().__init__(array, *nodes)
        grid = self.values.reshape(-1, self.rows, self.columns)
        across = np.zeros(grid.shape)
        np.cumsum((grid[..., 1:] + grid[..., :-1]) / 2, axis=-1, out=across[..., 1:])
        down = np.zeros(grid.shape[:2])
        ends = across[..., -1]
        np.cumsum((ends[:, 1:] + ends[:, :-1]) / 2, axis=-1, out=down[:, 1:])
        whole = down[:, -1:]
        if not (np.isfinite(whole).all() and (whole > 0).all() and (grid >= 0).all()):
            raise ValueError("A density must be positive and finite.")
        self.values = self.values / whole[..., None]
        self.across = (across / whole[..., None]).reshape(len(grid), 1, -1)
        self.down = (down / whole)[:, None]

    def invert(self, points: Points, slices: Slices) -> Points:
        """Uniform points that the warp takes to ``points``."""
        column, row, x, y = self.patch(points)
        node = row * self.columns + column

        def at(table: np.ndarray, where: np.ndarray) -> Numbers:
            return blend(table, slices, where)[:, 0]

        def between_rows(table: np.ndarray, where: np.ndarray) -> Numbers:
            return (1 - y) * at(table, where) + y * at(table, where + self.columns)

        left = between_rows(self.values, node)
        right = between_rows(self.values, node + 1)
        first = (row + 1) * self.columns - 1  # where the row ends
        s = between_rows(self.across, node) + x * (left + x * (right - left) / 2)
        s = s / np.maximum(between_rows(self.across, first), np.finfo(float).tiny)
        top, bottom = at(self.across, first), at(self.across, first + self.columns)
        t = at(self.down, row) + y * (top + y * (bottom - top) / 2)
        return np.clip(np.stack([s, t], axis=1), 0, 1)

    def sample(self, uniform: Points, index: int) -> Points:
        """Where the warp of one slice takes uniform points."""
        s, t = uniform.T
        grid = self.values[index, 0].reshape(self.rows, self.columns)
        across = self.across[index, 0].reshape(self.rows, self.columns)
        down = self.down[index, 0]
        row = np.clip(np.searchsorted(down, t) - 1, 0, self.rows - 2)
        y = crossing(t - down[row], across[row, -1], across[row + 1, -1])
        weight = y[:, None]
        levels = (1 - weight) * across[row] + weight * across[row + 1]
        s = s * levels[:, -1]
        column = np.clip((levels < s[:, None]).sum(axis=1) - 1, 0, self.columns - 2)
        points = np.arange(len(s))
        density = (1 - weight) * grid[row] + weight * grid[row + 1]
        x = crossing(
            s - levels[points, column],
            density[points, column],
            density[points, column + 1],
        )
        return np.stack(
            [(column + x) / (self.columns - 1), (row + y) / (self.rows - 1)], axis=1
        )


def blend(table: np.ndarray, slices: Slices, node: np.ndarray) -> np.ndarray:
    """One node of a table ``(slice, channel, node)``, interpolated between slices."""
    index, weight = slices
    total = np.zeros((len(node), table.shape[1]))
    for corner in range(index.shape[1]):
        share = np.broadcast_to(weight[:, corner, None], (len(node), 1))
        total += share * table[np.broadcast_to(index[:, corner], len(node)), :, node]
    return total


def crossing(area: Numbers, start: Numbers, end: Numbers) -> Numbers:
    """Where in [0, 1] the integral of a line from ``start`` to ``end`` is ``area``.

    The root of the quadratic in the form that does not cancel when they are equal.
    """
    root = np.sqrt(np.maximum(start**2 + 2 * area * (end - start), 0))
    return np.clip(2 * area / np.maximum(start + root, np.finfo(float).tiny), 0, 1)
