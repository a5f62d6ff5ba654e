"""A scene: everything an image depends on except the BRDF."""

import math
from collections.abc import Sequence
from functools import partial

import equinox as eqx
import numpy as np

from brdffit.geometry import TANGENTS
from brdffit.models.base import RGB
from brdffit.names import look_up
from brdffit.scene import values
from brdffit.scene.camera import Camera, Orthographic
from brdffit.scene.lights import Ambient, Directional, Environment, Light, Point
from brdffit.scene.shadows import ShadowRays, Shadows
from brdffit.scene.shapes import Material, Shape, Sphere
from brdffit.scene.style import Gooch
from brdffit.types import AnyArray

DEEPEST = 1000  # reflections and refractions that are followed


class Scene(eqx.Module):
    """A camera looks at shapes under lights.

    Attributes:
        camera: Which ray belongs to which pixel.
        shapes: What the rays meet. Those without a material of their own are made of
            what the scene is rendered with, or fitted.
        lights: One or more lights that shine together.
        exposure: Value of a pixel for unit radiance.
        tangents: Name of the field of tangents on the shapes, one of those in
            `geometry.TANGENTS`. Isotropic models do not depend on it.
        shadows: How shadows are found, where there are any.
        depth: How often a ray is reflected or refracted at most before it is given up.
        style: A style instead of light and shade, or None.

    Raises:
        ValueError: There is no shape or no light, or two light probes; lights or
            materials differ in their number of channels; the exposure is not a
            positive number, or there is no such field of tangents.
    """

    camera: Camera
    shapes: tuple[Shape, ...] = eqx.field(converter=tuple)
    lights: tuple[Light, ...] = eqx.field(converter=tuple)
    exposure: float = eqx.field(
        default=1.0, converter=partial(values.positive, "exposure")
    )
    tangents: str = eqx.field(static=True, default="cylindrical", converter=str)
    shadows: Shadows = ShadowRays()
    depth: int = eqx.field(
        static=True,
        default=6,
        converter=partial(values.whole, "depth", least=0, most=DEEPEST),
    )
    style: Gooch | None = None

    def __check_init__(self) -> None:
        """Check what can be wrong about the whole."""
        look_up(TANGENTS, self.tangents, "`tangents`")
        if not self.shapes:
            raise ValueError("`shapes` must hold at least one shape.")
        if not self.lights:
            raise ValueError("`lights` must hold at least one light.")
        if sum(isinstance(light, Environment) for light in self.lights) > 1:
            raise ValueError("`lights` must hold at most one light probe.")
        if len(sizes := self._channels_of_lights()) > 1:
            raise ValueError(
                "Lights must have the same number of channels, "
                f"but have {', '.join(map(str, sorted(sizes)))}."
            )
        if self.style and not any(
            isinstance(light, Directional | Point) for light in self.lights
        ):
            raise ValueError(
                "`style` needs a directional light or a point light in `lights`."
            )
        for number, shape in enumerate(self.shapes):
            if (count := _channels(shape.material)) is not None:
                self.check_channels(count, f"`shapes[{number}]`")

    @property
    def channels(self) -> int | None:
        """Number of channels of the lights, or None when each gives one number."""
        return next(iter(self._channels_of_lights()), None)

    def channels_for(self, wanted: int | None) -> int:
        """Number of channels of an image: as asked for, else that of the lights or RGB.

        Raises:
            ValueError: The lights, a material or the style have another number.
        """
        channels = wanted or self.channels or RGB
        if self.channels not in (None, channels):
            raise ValueError(
                f"Lights have {self.channels} channels, but {channels} are asked for."
            )
        for number, shape in enumerate(self.shapes):
            if (count := _channels(shape.material)) not in (None, channels):
                raise ValueError(
                    f"The material of `shapes[{number}]` has {count} "
                    f"channels, but {channels} are asked for."
                )
        for key in ("cool", "warm") if self.style else ():
            if (colour := getattr(self.style, key)).shape not in ((), (channels,)):
                raise ValueError(
                    f"`{key}` of `style` must be one number or {channels}, one for "
                    f"each channel, but has {colour.size}."
                )
        return channels

    def check_channels(self, count: int, place: str) -> None:
        """Refuse a material that the lights do not fit.

        Raises:
            ValueError: It has another number of channels.
        """
        if self.channels not in (None, count):
            raise ValueError(
                f"The material of {place} must have the {self.channels} channels of "
                f"the lights, but has {count}."
            )

    @property
    def probe(self) -> Environment | None:
        """The light probe, if there is one."""
        probes = [light for light in self.lights if isinstance(light, Environment)]
        return probes[0] if probes else None

    @property
    def ambient(self) -> np.ndarray:
        """Radiance of the ambient light, a number or one for each channel."""
        amounts = [s.radiance for s in self.lights if isinstance(s, Ambient)]
        return np.asarray(sum(amounts, np.zeros(())))

    def _channels_of_lights(self) -> set[int]:
        shapes = {light.amount.shape for light in self.lights} - {()}
        return {count for (count,) in shapes}


def _channels(material: Material | None) -> int | None:
    """How many a material has, or None where it takes any number."""
    return getattr(material, "channels", None)


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
    return Scene(Orthographic(resolution), (Sphere(),), lights, exposure, tangents)
