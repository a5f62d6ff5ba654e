"""How far an exported material is from the BRDF that it came from."""

import dataclasses

import numpy as np

from brdffit.exports.material import Evaluate
from brdffit.types import Vectors

PAIRS = 4000
LOWEST = np.cos(np.radians(80))  # directions nearer to the horizon are left out
WIDTHS = (1e-3, 1.0)  # slopes of half vectors, as often in each decade
FLOOR = 1e-3  # 1/sr; the error of smaller values is relative to this


@dataclasses.dataclass(frozen=True)
class Deviation:
    """Relative differences of f_r over pairs of directions spread by `pairs`.

    Attributes:
        largest: The largest.
        mean: The mean of all.
        theta_i: Polar angle of the light where the largest is, in degrees.
        theta_o: Polar angle of the viewer there.
        count: Number of pairs.
    """

    largest: float
    mean: float
    theta_i: float
    theta_o: float
    count: int

    def __str__(self) -> str:
        return (
            f"largest {self.largest:.2g} (light at {self.theta_i:.0f}, viewer at "
            f"{self.theta_o:.0f} degrees), mean {self.mean:.2g}"
        )


def deviation(truth: Evaluate, found: Evaluate) -> Deviation:
    """``|found - truth| / max(truth, 0.001/sr)`` over `pairs`, every channel by itself.

    Raises:
        ValueError: What was found is not finite somewhere.
    """
    wi, wo = pairs()
    exact, other = truth(wi, wo), found(wi, wo)
    if not np.isfinite(other).all():
        raise ValueError("The exported material is not finite in all directions.")
    error = np.abs(other - exact) / np.maximum(exact, FLOOR)
    worst = int(error.max(axis=1).argmax())
    theta_i, theta_o = (float(np.degrees(np.arccos(w[worst, 2]))) for w in (wi, wo))
    return Deviation(float(error.max()), float(error.mean()), theta_i, theta_o, len(wi))


def pairs(count: int = PAIRS, seed: int = 0) -> tuple[Vectors, Vectors]:
    """Directions up to 80 degrees; in half of the pairs they nearly mirror each other.

    There the slope of the half vector is drawn from 0.001 to 1 with equal chances in
    every decade, so that a lobe of any width is seen.
    """
    random = np.random.default_rng(seed)
    wi, wo = hemisphere(random, (2, 8 * count))
    low, high = np.log(WIDTHS)
    slope = np.exp(random.uniform(low, high, 8 * count))
    turn = random.uniform(0, 2 * np.pi, 8 * count)
    half = np.stack([slope * np.cos(turn), slope * np.sin(turn), 1 + 0 * slope], axis=1)
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    near = 2 * np.sum(wi * half, axis=1, keepdims=True) * half - wi
    wo = np.where((np.arange(8 * count) % 2)[:, None], near, wo)
    rows = np.flatnonzero(wo[:, 2] > LOWEST)
    even = rows[rows % 2 == 0][: count // 2]
    odd = rows[rows % 2 == 1][: count - count // 2]
    chosen = np.sort(np.concatenate([even, odd]))
    return wi[chosen], wo[chosen]


def hemisphere(random: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """Unit vectors ``(*shape, 3)`` even in solid angle, up to 80 degrees."""
    z = random.uniform(LOWEST, 1, shape)
    turn, radius = random.uniform(0, 2 * np.pi, shape), np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=-1)
