"""A scene: everything an image depends on except the BRDF."""

import math
from collections.abc import Sequence
from functools import partial

import equinox as eqx

from brdffit.geometry import TANGENTS
from brdffit.names import look_up
from brdffit.scene import values
from brdffit.scene.camera import Orthographic
from brdffit.scene.lights import Directional
from brdffit.scene.shapes import Sphere
from brdffit.types import AnyArray


class Scene(eqx.Module):
    """A camera looks at a shape under lights.

    Attributes:
        camera: Which ray belongs to which pixel.
        shape: What the rays meet.
        lights: One or more lights that shine together.
        exposure: Value of a pixel for unit radiance.
        tangents: Name of the field of tangents on the shape, one of those in
            `geometry.TANGENTS`. Isotropic models do not depend on it.

    Raises:
        ValueError: There is no light, lights differ in their number of channels, the
            exposure is not a positive number, or there is no such field of tangents.
    """

    camera: Orthographic
    shape: Sphere
    lights: tuple[Directional, ...]
    exposure: float = eqx.field(
        default=1.0, converter=partial(values.positive, "exposure")
    )
    tangents: str = eqx.field(static=True, default="cylindrical", converter=str)

    def __check_init__(self) -> None:
        """Check what can be wrong about the whole."""
        look_up(TANGENTS, self.tangents, "`tangents`")
        if not self.lights:
            raise ValueError("`lights` must hold at least one light.")
        sizes = {light.irradiance.shape for light in self.lights} - {()}
        if len(sizes) > 1:
            raise ValueError(
                "`irradiance` must have the same number of channels in all lights, "
                f"but has {', '.join(sorted(str(size) for (size,) in sizes))}."
            )

    @property
    def channels(self) -> int | None:
        """Number of channels of the lights, or None when each gives one number."""
        sizes = {light.irradiance.shape for light in self.lights} - {()}
        return sizes.pop()[0] if sizes else None


def lit_sphere(
    resolution: int = 256,
    directions: Sequence[values.Numbers] | AnyArray = ((-0.48, 0.6, 0.64),),
    irradiance: values.Numbers = math.pi,
    exposure: float = 1.0,
    tangents: str = "cylindrical",
) -> Scene:
    """A unit sphere that fills the frame, under equal directional lights.

    Args:
        resolution: Rows and columns of the image.
        directions: Unit vectors towards the lights: x right, y up, z to the viewer.
        irradiance: Of each light, a number or one for each channel; with pi a white
            diffuse surface that faces the light has the value 1.
        exposure: Value of a pixel for unit radiance.
        tangents: Name of the field of tangents: linear, radial or cylindrical.
    """
    lights = tuple(Directional(direction, irradiance) for direction in directions)
    return Scene(Orthographic(resolution), Sphere(), lights, exposure, tangents)
