"""A light probe as a weighted set of directions."""

import heapq
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from brdffit.scene import Environment


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
        moments = np.concatenate([grey, grey * direction, light], axis=-1)
        rows, columns, numbers = moments.shape
        self.sums = np.zeros((rows + 1, columns + 1, numbers))
        self.sums[1:, 1:] = moments.cumsum(axis=0).cumsum(axis=1)
        self.boxes, self.cut_at = [], []
        self.heap: list[tuple[float, int]] = []
        self._add((0, rows, 0, columns))

    def rule(self, count: int) -> Rule:
        """As many directions, or one for each pixel where there are fewer of them."""
        while len(self.heap) < count and self._cut():
            pass
        boxes, cut_at = np.array(self.boxes), np.array(self.cut_at)
        # the cut that makes n into n + 1 adds two boxes: 2n - 1 and 2n
        born = (np.arange(len(boxes)) + 1) // 2 + 1
        alive = boxes[(born <= count) & (cut_at >= count)]
        total = self._sum(*alive.T)
        length = np.linalg.norm(total[:, 1:4], axis=1)
        lit = length > 0
        towards = total[lit, 1:4] / length[lit, None]
        return Rule(towards, total[lit, 4:])

    def _add(self, box: tuple[int, ...]) -> None:
        self.boxes.append(box)
        self.cut_at.append(np.iinfo(np.int64).max)
        spread = float(_spread(self._sum(*box)))
        heapq.heappush(self.heap, (-spread, len(self.boxes) - 1))

    def _cut(self) -> bool:
        """Cut the rectangle with the largest spread; False when nothing is left."""
        spread, which = self.heap[0]
        if spread == 0:
            return False
        top, bottom, left, right = box = self.boxes[which]
        whole = self._sum(*box)
        best = (np.inf, box, box)
        if bottom - top > 1:
            at = np.arange(top + 1, bottom)
            n, least = self._least(self._sum(top, at, left, right), whole)
            edge = int(at[n])
            halves = (top, edge, left, right), (edge, bottom, left, right)
            best = min(best, (least, *halves), key=lambda cut: cut[0])
        if right - left > 1:
            at = np.arange(left + 1, right)
            n, least = self._least(self._sum(top, bottom, left, at), whole)
            edge = int(at[n])
            halves = (top, bottom, left, edge), (top, bottom, edge, right)
            best = min(best, (least, *halves), key=lambda cut: cut[0])
        if not np.isfinite(best[0]):  # a single pixel
            heapq.heapreplace(self.heap, (0.0, which))
            return True
        heapq.heappop(self.heap)
        self.cut_at[which] = len(self.heap) + 1
        for half in best[1:]:
            self._add(half)
        return True

    def _least(self, one: np.ndarray, whole: np.ndarray) -> tuple[int, float]:
        """Which cut leaves least spread, and how much."""
        spread = _spread(one) + _spread(whole - one)
        best = int(np.argmin(spread))
        return best, float(spread[best])

    def _sum(self, top, bottom, left, right) -> np.ndarray:
        sums = self.sums
        return (
            sums[bottom, right]
            - sums[top, right]
            - sums[bottom, left]
            + sums[top, left]
        )


def _spread(sums: np.ndarray) -> np.ndarray:
    """Brightness times the variance of directions, from sums over a rectangle."""
    grey, moment = sums[..., 0], sums[..., 1:4]
    safe = np.where(grey > 0, grey, 1)
    spread = np.maximum(grey - np.sum(moment * moment, axis=-1) / safe, 0)
    return np.where(spread > 1e-12 * grey, spread, 0)


def texels(
    probe: Environment, most: int = 2**62
) -> tuple[Float[np.ndarray, "row column channel"], Float[np.ndarray, "row column 3"]]:
    """Light of each pixel of a probe, radiance times solid angle, and its direction.

    Light of a pixel is the mean between the centres of pixels around it, as an image of
    the probe shows it. Beyond ``most`` pixels, neighbours are put together.
    """
    pixels = probe.scale * probe.map.pixels
    while pixels.shape[0] * pixels.shape[1] > most and not any(
        n % 2 for n in pixels.shape[:2]
    ):
        pixels = (pixels[::2] + pixels[1::2]) / 2
        pixels = (pixels[:, ::2] + pixels[:, 1::2]) / 2
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
