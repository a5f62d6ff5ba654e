"""Lights: from where, and how much of it."""

from functools import partial
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit.scene import values
from brdffit.scene.maps import Map

Spectrum = Float[np.ndarray, "..."]  # a number for all channels, or one for each


class Ambient(eqx.Module):
    """Light that comes evenly from everywhere and reaches every point.

    It is the term of the classic lighting equations: what is added to a pixel is the
    diffuse reflectance times the radiance. Nothing casts a shadow in it, and it has no
    highlights; for that, take a probe of constant radiance.

    Attributes:
        radiance: Of the light, the same from all directions.
    """

    radiance: Spectrum = eqx.field(converter=partial(values.spectrum, "radiance"))

    @property
    def amount(self) -> Spectrum:
        """What has the channels of the light."""
        return self.radiance


class Directional(eqx.Module):
    """A light so far away that it comes from one direction everywhere.

    Attributes:
        direction: Unit vector towards the light, in the frame of the world.
        irradiance: What falls on a surface that faces the light: a number for all
            channels, or one for each.

    Raises:
        ValueError: The direction is not a unit vector within 0.001, or the irradiance
            is negative.
    """

    direction: Float[np.ndarray, "3"] = eqx.field(
        converter=partial(values.unit_vector, "direction")
    )
    irradiance: Spectrum = eqx.field(
        default=1.0, converter=partial(values.spectrum, "irradiance")
    )

    @property
    def amount(self) -> Spectrum:
        """What has the channels of the light."""
        return self.irradiance


class Point(eqx.Module):
    """A light at one point that shines evenly in all directions.

    Attributes:
        position: Where it is.
        intensity: Irradiance at distance 1 of a surface that faces the light: a number
            for all channels, or one for each.
    """

    position: Float[np.ndarray, "3"] = eqx.field(
        converter=partial(values.point, "position")
    )
    intensity: Spectrum = eqx.field(
        default=1.0, converter=partial(values.spectrum, "intensity")
    )

    @property
    def amount(self) -> Spectrum:
        """What has the channels of the light."""
        return self.intensity


class Environment(eqx.Module):
    """A light probe: radiance from infinitely far away, from every direction.

    The map is in latitude and longitude: its top row is up (+y), the middle of a row
    looks along +z, and its ends meet at -z, with +x a quarter to the right of them.
    This is the convention of Mitsuba. Where no shape is, the probe is seen.

    Attributes:
        map: Image file (EXR, HDR) or pixels, linear radiance.
        scale: Factor of all its values.

    Raises:
        ValueError: The map is negative, not finite or black.
        OSError: The file cannot be read.
    """

    map: Map = eqx.field(converter=partial(Map.of, "map"))
    scale: float = eqx.field(default=1.0, converter=partial(values.positive, "scale"))

    def __check_init__(self) -> None:
        """Refuse radiance that no light has."""
        pixels = self.map.pixels
        if not np.all(np.isfinite(pixels) & (pixels >= 0)) or not pixels.any():
            raise ValueError(
                f"`map` must hold finite radiance, none negative and some above 0, but "
                f"{self.map} does not."
            )

    @property
    def amount(self) -> Spectrum:
        """What has the channels of the light."""
        channels = self.map.pixels.shape[-1]
        return np.full(() if channels == 1 else channels, self.scale)

    def radiance(self, direction: Float[np.ndarray, "n 3"]) -> np.ndarray:
        """Radiance ``(N, C)`` that comes from unit vectors towards the sky."""
        x, y, z = direction.T
        u = np.arctan2(x, -z) / (2 * np.pi)
        v = np.arccos(np.clip(y, -1, 1)) / np.pi
        return self.scale * self.map(np.stack([u, v], axis=-1))


Light = Ambient | Directional | Point | Environment
LIGHTS: dict[str, Any] = {
    "ambient": Ambient,
    "directional": Directional,
    "point": Point,
    "environment": Environment,
}
