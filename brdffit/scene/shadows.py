"""How shadows are found."""

from functools import partial

import equinox as eqx

from brdffit.scene import values


class ShadowRays(eqx.Module):
    """Exactly, by a ray from each point to each light."""


class ShadowMap(eqx.Module):
    """By a picture of what each light sees first, as rasterisers do.

    A point is in shadow when it lies behind what the picture shows there, by more than
    the bias: the depth over which a surface that slants away from the light extends
    within a pixel, times ``slope_bias``, plus ``bias`` pixels.

    Directional lights have one square picture, point lights the six faces of a cube.
    Shadows in a light probe are always found by rays.

    Attributes:
        resolution: Pixels along each side of a picture.
        slope_bias: Factor of the depth of a slanting surface within a pixel.
        bias: Constant part of the bias, in pixels.
    """

    resolution: int = eqx.field(
        static=True,
        default=1024,
        converter=partial(values.whole, "resolution", least=1, most=values.SIDE),
    )
    slope_bias: float = eqx.field(
        default=1.0, converter=partial(values.not_negative, "slope_bias")
    )
    bias: float = eqx.field(
        default=0.05, converter=partial(values.not_negative, "bias")
    )


Shadows = ShadowRays | ShadowMap
SHADOWS = {"rays": ShadowRays, "map": ShadowMap}
