"""Planes to look at reflectance in: which samples lie in one, and at which angle.

A goniometer is cut along its planes of incidence. A sphere under one light is cut along
the great circle through light and viewer, where the angle between the two is fixed and
the normal turns.
"""

import dataclasses
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from brdffit.samples import Measurement, Samples, as_samples
from brdffit.types import AnyArray

FEWEST = 5  # samples that make a lobe
SETTINGS = 100  # directions of incidence beyond which they count as scattered
SAME = 0.5  # degrees within which two angles of incidence are one
THIN = 1.5  # degrees from its plane within which a sample is in it
WIDTHS = (1.0, 2.0, 5.0)  # degrees within which scattered directions are gathered
ENOUGH = 40  # samples in a plane that make the next width needless
CENTRES = (
    15.0,
    30.0,
    45.0,
    60.0,
    75.0,
)  # degrees, angles of incidence of scattered directions
CURVE = np.linspace(-90, 90, 721)  # degrees, where models are drawn


@dataclasses.dataclass(frozen=True)
class Plane:
    """Samples of one plane in the order of their angle, and where to draw models.

    Attributes:
        title: What is fixed.
        label: What the angle is.
        angle: Signed angle of each sample in degrees.
        f_r: Measured reflectance, NaN where it must not be used.
        curve: Signed angles at which models are drawn.
        wi: Directions to the light along the curve.
        wo: Directions to the viewer along the curve.
        mirror: Angle of the mirror direction in degrees.
    """

    title: str
    label: str
    angle: Float[np.ndarray, " sample"]
    f_r: Float[np.ndarray, "sample channel"]
    curve: Float[np.ndarray, " point"]
    wi: Float[np.ndarray, "point 3"]
    wo: Float[np.ndarray, "point 3"]
    mirror: float


def planes(data: Measurement | Samples) -> list[Plane]:
    """All planes with enough samples; none where several lights shine at once.

    Scattered directions, of which no plane of incidence has enough, are gathered within
    a few degrees and turned to one azimuth.
    """
    samples = as_samples(data)
    if samples.value is None or samples.wi.shape[1] != 1:
        return []
    masked = np.zeros(samples.value.shape, bool)
    if samples.mask is not None:
        masked = ~np.asarray(samples.mask)
    below = np.asarray(samples.wi)[:, 0, 2:] <= 0
    value = np.where(masked | below, np.nan, np.asarray(samples.value))
    samples = dataclasses.replace(samples, value=value)
    samples = samples.take(np.flatnonzero(np.isfinite(samples.f_r).any(axis=1)))
    if samples.pixels is not None:
        found = [great_circle(samples, f) for f in range(samples.pixels.shape[0])]
    else:
        found = list(planes_of_incidence(samples))
    found = [plane for plane in found if plane and len(plane.angle) >= FEWEST]
    if not found and samples.pixels is None:
        found = gathered(samples)
    return found


def planes_of_incidence(samples: Samples) -> Iterator[Plane]:
    """Planes that were measured as such, one for each direction of incidence."""
    theta, phi = polar(samples.wi[:, 0])
    phi = np.where(theta < SAME, 0, phi % 360)
    rounded = np.round(np.stack([theta, phi], axis=1) / SAME).astype(int)
    settings, member = np.unique(rounded, axis=0, return_inverse=True)
    if len(settings) > SETTINGS:
        return
    several = len(np.unique(settings[settings[:, 0] > 0, 1])) > 1
    for number in range(len(settings)):
        here = member == number
        theta_i, phi_i = theta[here].mean(), phi[here].mean()
        title = rf"$\theta_i = {round(theta_i, 1):g}\degree$"
        if several:
            title += rf", $\phi_i = {round(phi_i, 1):g}\degree$"
        group = samples.take(here)
        if theta_i < SAME:
            phi_i = fullest_azimuth(group)
        yield cut(group, np.full(len(group), phi_i), theta_i, phi_i, THIN, title)


def gathered(samples: Samples) -> list[Plane]:
    """Scattered samples near a few angles of incidence, as near as leaves enough."""
    theta, phi = polar(samples.wi[:, 0])
    found = []
    for width in WIDTHS:
        found = []
        for centre in CENTRES:
            near = np.abs(theta - centre) <= width
            title = rf"$\theta_i = {centre:.0f}\degree \pm {width:.0f}\degree$"
            plane = cut(samples.take(near), phi[near], centre, 0.0, width, title)
            if len(plane.angle) >= FEWEST:
                found.append(plane)
        if found and min(len(plane.angle) for plane in found) >= ENOUGH:
            break
    return found


def cut(
    samples: Samples,
    azimuth: Float[np.ndarray, " sample"],
    theta_i: float,
    phi_i: float,
    thickness: float,
    title: str,
) -> Plane:
    """Samples within ``thickness`` of the plane of incidence at their own azimuth.

    Models are drawn for the light at ``theta_i, phi_i``. All angles are in degrees.
    """
    x, y, z = np.asarray(samples.wo, float).T
    turn = np.radians(azimuth)
    towards_light = x * np.cos(turn) + y * np.sin(turn)
    aside = y * np.cos(turn) - x * np.sin(turn)
    here = np.abs(aside) <= np.sin(np.radians(thickness))
    angle = np.degrees(np.arctan2(-towards_light, z))[here]
    order = np.argsort(angle)
    return Plane(
        title=title,
        label=r"$\theta_o$ [degrees], mirror side positive",
        angle=angle[order],
        f_r=samples.f_r[here][order],
        curve=CURVE,
        wi=np.tile(direction(np.array([theta_i]), phi_i), (len(CURVE), 1)),
        wo=direction(-CURVE, phi_i),
        mirror=float(theta_i),
    )


def great_circle(samples: Samples, frame: int) -> Plane | None:
    """Pixels of one frame whose normal lies in the plane of light and viewer.

    None where the light stands behind the viewer and so makes no plane with him. Models
    are drawn at the pixels themselves, because a tangent may turn from one to the next.
    """
    assert samples.pixels is not None  # for the type checker
    group = samples.take(np.asarray(samples.pixels.frame) == frame)
    wi, wo = np.asarray(group.wi[:, 0], float), np.asarray(group.wo, float)
    across = np.cross(wi, wo)
    length = np.linalg.norm(across, axis=1)
    if not len(group) or length.min() < np.sin(np.radians(THIN)):
        return None
    phase = np.degrees(np.arctan2(length, np.sum(wi * wo, axis=1))).mean()
    here = np.abs(across[:, 2]) <= length * np.sin(np.radians(THIN))
    wi, wo = wi[here], wo[here]
    tilt, _ = polar(wi + wo)
    angle = np.where(wo[:, 2] > wi[:, 2], tilt, -tilt)
    order = np.argsort(angle)
    return Plane(
        title=f"light {frame + 1}, {phase:.0f}$\\degree$ from the viewer",
        label=r"$\theta_h$ [degrees], viewer's side positive",
        angle=angle[order],
        f_r=group.f_r[here][order],
        curve=angle[order],
        wi=wi[order],
        wo=wo[order],
        mirror=0.0,
    )


def fullest_azimuth(samples: Samples) -> float:
    """Azimuth in degrees of the plane through the normal with the most viewers."""
    _, phi = polar(samples.wo)
    half_turns, counts = np.unique(
        np.round(phi / SAME) * SAME % 180, return_counts=True
    )
    return float(half_turns[np.argmax(counts)])


def polar(w: AnyArray) -> tuple[np.ndarray, np.ndarray]:
    """Angle to the normal and azimuth of directions ``(N, 3)`` in degrees."""
    x, y, z = np.asarray(w, float).T
    return np.degrees(np.arctan2(np.hypot(x, y), z)), np.degrees(np.arctan2(y, x))


def direction(theta: Float[np.ndarray, " point"], phi: float) -> np.ndarray:
    """Unit vectors ``(N, 3)`` with these angles in degrees."""
    theta, turn = np.radians(theta), np.radians(phi)
    x, y = np.sin(theta) * np.cos(turn), np.sin(theta) * np.sin(turn)
    return np.stack([x, y, np.cos(theta)], axis=-1)
