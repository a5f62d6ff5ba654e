"""Styles: pictures that show a shape instead of a photograph of it."""

from functools import partial

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit.scene import values

Colour = Float[np.ndarray, "..."]


class Gooch(eqx.Module):
    """Cool where a surface turns from the first light, warm where it faces it.

    Attributes:
        cool, warm: Colours of the two ends, a number or one for each channel.
        cool_diffuse, warm_diffuse: How much of the colour of the material, its diffuse
            reflectance, is mixed into the two ends.
        steps: Number of tones, or 0 for all between.
        outlines: Whether edges of shapes and creases are drawn in black.
        highlight: Brightness of a white highlight.
        exponent: Its narrowness, an exponent of Phong.
    """

    cool: Colour = eqx.field(
        default=(0.0, 0.0, 0.55), converter=partial(values.spectrum, "cool")
    )
    warm: Colour = eqx.field(
        default=(0.3, 0.3, 0.0), converter=partial(values.spectrum, "warm")
    )
    cool_diffuse: float = eqx.field(
        default=0.25, converter=partial(values.not_negative, "cool_diffuse")
    )
    warm_diffuse: float = eqx.field(
        default=0.5, converter=partial(values.not_negative, "warm_diffuse")
    )
    steps: int = eqx.field(
        static=True, default=0, converter=partial(values.whole, "steps", least=0)
    )
    outlines: bool = eqx.field(
        static=True, default=True, converter=partial(values.boolean, "outlines")
    )
    highlight: float = eqx.field(
        default=0.0, converter=partial(values.not_negative, "highlight")
    )
    exponent: float = eqx.field(
        default=30.0, converter=partial(values.not_negative, "exponent")
    )


STYLES = {"gooch": Gooch}
