"""A light probe as a weighted set of directions."""

import heapq
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from brdffit.scene import Environment

CUTS = 2**15  # most directions found by cutting, which take about a second


class Rule(NamedTuple):
    """Directions, and what comes from each: the irradiance of a surface facing it."""

    towards: Float[np.ndarray, "direction 3"]
    irradiance: Float[np.ndarray, "direction channel"]


class Regions:
    """A probe cut into rectangles, one direction for each, where it matters most.

    The rectangle whose light is spread most, weighed with its brightness, is cut in
    two, so that the spread of both together is least; and again, as often as asked for.
    Each stands for all of its light, which comes from its middle. So directions are
    dense where light is, and energy is exact for any number of them. For a BRDF that is
    smooth over a rectangle, the error falls with the number itself, where that of
    random directions falls with its root.

    Source:
        K. Viriyothai and P. Debevec, "Variance Minimization Light Probe Sampling",
        SIGGRAPH 2009 posters; with the bounds found from sums over rectangles as in
        F. Crow, "Summed-Area Tables for Texture Mapping", SIGGRAPH 1984.
    """

    def __init__(self, probe: Environment) -> None:
        """Sum the light of the probe."""
        light, direction = texels(probe)
        grey = light.mean(axis=-1, keepdims=True)
        self.moments = np.concatenate([grey, grey * direction, light], axis=-1)
        rows, columns, numbers = self.moments.shape
        self.pixels = rows * columns
        self.sums = np.zeros((rows + 1, columns + 1, numbers))
        self.sums[1:, 1:] = self.moments.cumsum(axis=0).cumsum(axis=1)
        self.boxes, self.cut_at = [], []
        self.heap: list[tuple[float, int]] = []
        self._add((0, rows, 0, columns), np.inf)

    def rule(self, count: int) -> Rule:
        """As many directions, or one for each pixel where there are fewer of them.

        Beyond ``CUTS``, all are the middles of blocks, see there.
        """
        if count >= self.pixels or count > CUTS:
            return self.blocks(count)
        while len(self.heap) < count and self._cut():
            pass
        boxes, cut_at = np.array(self.boxes), np.array(self.cut_at)
        # the cut that makes n into n + 1 adds two boxes: 2n - 1 and 2n
        born = (np.arange(len(boxes)) + 1) // 2 + 1
        alive = boxes[(born <= count) & (cut_at >= count)]
        return _middles(self._sum(*alive.T))

    def blocks(self, most: int) -> Rule:
        """One direction for each square of pixels, as small as gives no more than that.

        With as many directions as pixels, the squares are the pixels, and light of the
        probe is as it is. Pixels without light are left out.
        """
        rows, columns, numbers = self.moments.shape
        side = 1
        while -(-rows // side) * -(-columns // side) > most:
            side += 1
        total = np.add.reduceat(self.moments, np.arange(0, rows, side), axis=0)
        total = np.add.reduceat(total, np.arange(0, columns, side), axis=1)
        return _middles(total.reshape(-1, numbers))

    def _add(self, box: tuple[int, ...], spread: float) -> None:
        self.boxes.append(box)
        self.cut_at.append(np.iinfo(np.int64).max)
        heapq.heappush(self.heap, (-spread, len(self.boxes) - 1))

    def _cut(self) -> bool:
        """Cut the rectangle with the largest spread; False when nothing is left."""
        largest, which = self.heap[0]
        if largest == 0:
            return False
        top, bottom, left, right = self.boxes[which]
        rows, columns = np.arange(top + 1, bottom), np.arange(left + 1, right)
        if not len(rows) and not len(columns):  # a single pixel
            heapq.heapreplace(self.heap, (0.0, which))
            return True
        one = np.concatenate(
            [
                self._sum(top, rows, left, right),
                self._sum(top, bottom, left, columns),
            ]
        )
        other = self._sum(top, bottom, left, right) - one
        spread = _spread(np.stack([one, other]))
        best = int(np.argmin(spread.sum(axis=0)))
        if best < len(rows):
            edge = int(rows[best])
            halves = (top, edge, left, right), (edge, bottom, left, right)
        else:
            edge = int(columns[best - len(rows)])
            halves = (top, bottom, left, edge), (top, bottom, edge, right)
        heapq.heappop(self.heap)
        self.cut_at[which] = len(self.heap) + 1
        for half, rest in zip(halves, spread[:, best], strict=True):
            self._add(half, float(rest))
        return True

    def _sum(self, top, bottom, left, right) -> np.ndarray:
        sums = self.sums
        return (
            sums[bottom, right]
            - sums[top, right]
            - sums[bottom, left]
            + sums[top, left]
        )


def _middles(total: np.ndarray) -> Rule:
    """All light of each rectangle from its middle, where there is any."""
    length = np.linalg.norm(total[:, 1:4], axis=1)
    lit = length > 0
    return Rule(total[lit, 1:4] / length[lit, None], total[lit, 4:])


def _spread(sums: np.ndarray) -> np.ndarray:
    """Brightness times the variance of directions, from sums over a rectangle."""
    grey, moment = sums[..., 0], sums[..., 1:4]
    safe = np.where(grey > 0, grey, 1)
    spread = np.maximum(grey - np.sum(moment * moment, axis=-1) / safe, 0)
    return np.where(spread > 1e-12 * grey, spread, 0)


def texels(
    probe: Environment,
) -> tuple[Float[np.ndarray, "row column channel"], Float[np.ndarray, "row column 3"]]:
    """Light of each pixel of a probe, radiance times solid angle, and its direction.

    Light of a pixel is the mean between the centres of pixels around it, as an image of
    the probe shows it.
    """
    pixels = probe.scale * probe.map.pixels
    wide = (np.roll(pixels, 1, 1) + 6 * pixels + np.roll(pixels, -1, 1)) / 8
    up = np.concatenate([wide[:1], wide[:-1]])
    down = np.concatenate([wide[1:], wide[-1:]])
    pixels = (up + 6 * wide + down) / 8
    rows, columns = pixels.shape[:2]
    theta = np.pi * np.arange(rows + 1) / rows
    solid = -np.diff(np.cos(theta)) * 2 * np.pi / columns
    middle = (theta[1:] + theta[:-1])[:, None] / 2
    phi = 2 * np.pi * (np.arange(columns) + 0.5) / columns
    direction = np.stack(
        np.broadcast_arrays(
            np.sin(middle) * np.sin(phi), np.cos(middle), -np.sin(middle) * np.cos(phi)
        ),
        axis=-1,
    )
    return pixels * solid[:, None, None], direction
