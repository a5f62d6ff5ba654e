"""What light comes towards a point before anything stands in its way."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from brdffit.effects import falloff
from brdffit.effects.quadrature import Rule
from brdffit.scene import Directional, Environment, Point
from brdffit.scene.lights import Light
from brdffit.types import AnyArray

Vectors = Float[np.ndarray, "n 3"]


class Incident(NamedTuple):
    """Light from all directions that count; the first axis is 1 where all are alike.

    Attributes:
        towards: Unit directions to the light.
        irradiance: Of a surface that faces each direction.
        distance: To the light, infinite for what is not a point.
    """

    towards: Float[AnyArray, "point light 3"]
    irradiance: Float[AnyArray, "point light channel"]
    distance: Float[AnyArray, "point light"]


def incident(
    lights: Sequence[Light],
    position: Float[AnyArray, "n 3"],
    channels: int,
    sky: Rule | None,
    middle: AnyArray | None = None,
) -> Incident:
    """Light at points of a scene: of each light in turn, the probe's in a row.

    Args:
        lights: Those of the scene; ambient light comes from no direction and is left
            out.
        position: Points in the world, of numpy or of JAX.
        channels: Number of channels of the image.
        sky: Directions of the light probe, or None to leave it out.
        middle: Point as far as which all are from point lights, or None where the
            light of each falls off with its own distance.
    """
    xp = position.__array_namespace__()
    parts = []
    for light in lights:
        if isinstance(light, Directional):
            parts.append(
                Incident(
                    light.direction[None, None],
                    xp.broadcast_to(light.irradiance, channels)[None, None],
                    np.full((1, 1), np.inf),
                )
            )
        elif isinstance(light, Point):
            parts.append(
                Incident(*falloff.from_point(light, position, channels, middle))
            )
        elif isinstance(light, Environment) and sky is not None:
            count = len(sky.towards)
            parts.append(
                Incident(
                    sky.towards[None],
                    np.broadcast_to(sky.irradiance, (count, channels))[None],
                    np.full((1, count), np.inf),
                )
            )
    if not parts:
        return Incident(
            np.array([[[0.0, 0.0, 1.0]]]),
            np.zeros((1, 1, channels)),
            np.full((1, 1), np.inf),
        )
    if len(parts) == 1:
        return parts[0]
    count = max(len(part.distance) for part in parts)
    wide = [
        [xp.broadcast_to(array, (count, *array.shape[1:])) for array in part]
        for part in parts
    ]
    return Incident(
        *(xp.concatenate(arrays, axis=1) for arrays in zip(*wide, strict=True))
    )


def irradiance(light: Incident, normal: Vectors) -> np.ndarray:
    """Irradiance ``(point, light, channel)`` of surfaces with these normals."""
    cosine = np.einsum(
        "nk,nlk->nl",
        normal,
        np.broadcast_to(light.towards, (len(normal), *light.towards.shape[1:])),
    )
    return np.maximum(cosine, 0)[..., None] * light.irradiance
