"""Colour difference between two spheres, as an eye sees them on a screen.

The highlight is shown at the white of the screen, or just below, by one exposure for
both images. CIEDE2000 is computed in CIELAB of the shown colours, Delta E ITP in ICtCp
of the light that a screen with white at 100 cd/m^2 gives; 1 is about what an eye can
just tell apart.

Source:
    M. Luo, G. Cui, B. Rigg, "The Development of the CIE 2000 Colour-Difference
    Formula", Color Research and Application 26(5), 2001; Recommendation ITU-R BT.2124,
    2019.
"""

import dataclasses

import numpy as np

from brdffit.models import AbstractBRDF
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.samples import Measurement, Samples
from brdffit.scene import lit_sphere
from brdffit.types import Values

WHITE = 100.0  # cd/m^2 of a screen
BRIGHT = 99.0  # percentile of the pixels that is shown as white
RESOLUTION = 64  # of rendered spheres
LIGHTS = ((-0.48, 0.6, 0.64), (0.6, 0.0, 0.8))  # of rendered spheres, together
RGB = ("R", "G", "B")


@dataclasses.dataclass(frozen=True)
class ColourDifference:
    """Means over all pixels of a sphere.

    Attributes:
        ciede2000: CIEDE2000.
        itp: Delta E ITP.
    """

    ciede2000: float
    itp: float


def colour_difference(found: Values, wanted: Values) -> ColourDifference:
    """Difference between two sets of pixels ``(N, 3)``, linear Rec. 709 of any scale.

    Grey pixels ``(N, 1)`` are taken for neutral colours. The exposure is that which
    shows the wanted pixels, but for the brightest percent, up to white; what is
    brighter is white.

    Raises:
        ValueError: They have neither one channel nor three, or none of the wanted is
            above 0.
    """
    with np.printoptions():  # which colour-science sets back to those of numpy 1.13
        import colour  # takes more than a second

    found, wanted = (np.asarray(pixels, np.float64) for pixels in (found, wanted))
    if wanted.shape[-1] not in (1, 3) or not np.any(wanted > 0):
        raise ValueError(
            f"Pixels must have one channel or three, and light, to be told apart by "
            f"colour, but have {wanted.shape[-1]} channels."
        )
    white = np.percentile(wanted[wanted > 0], BRIGHT)
    shown = [
        np.clip(np.broadcast_to(pixels, (len(pixels), 3)) / white, 0, 1)
        for pixels in (found, wanted)
    ]
    xyz = [colour.RGB_to_XYZ(pixels, "ITU-R BT.709") for pixels in shown]
    first, second = (colour.XYZ_to_Lab(x) for x in xyz)
    wide = [colour.XYZ_to_RGB(x, "ITU-R BT.2020") * WHITE for x in xyz]
    itp = [colour.RGB_to_ICtCp(np.maximum(pixels, 0)) for pixels in wide]
    return ColourDifference(
        ciede2000=float(np.mean(colour.difference.delta_E_CIE2000(first, second))),
        itp=float(np.mean(colour.difference.delta_E_ITP(*itp))),
    )


def sphere_difference(
    brdf: AbstractBRDF,
    data: Measurement | Samples,
    reference: AbstractBRDF | None = None,
) -> ColourDifference | None:
    """How differently a fitted sphere looks.

    From the photographed one where data are pixels, and otherwise from the sphere of a
    reference, which is the best fit: single pairs of directions show no sphere.

    Args:
        brdf: The fitted model.
        data: What was fitted.
        reference: What to compare with where the data are no image.

    Returns:
        None where the channels are no colours, or there is nothing to compare with.
    """
    grey_or_rgb = brdf.channels == 1 or tuple(data.channels or RGB) == RGB
    if not grey_or_rgb or brdf.channels not in (1, 3):
        return None
    if isinstance(data, Samples) and data.pixels is not None and data.value is not None:
        value = np.asarray(data.value)
        use = np.isfinite(value).all(axis=1)
        if data.mask is not None:
            use &= np.asarray(data.mask).all(axis=1)
        if not use.any():
            return None
        rendered = np.asarray(compiled_shade(brdf, data))
        return colour_difference(rendered[use], value[use])
    if reference is None:
        return None
    samples = trace(lit_sphere(RESOLUTION, LIGHTS), channels=brdf.channels)
    found, wanted = (np.asarray(compiled_shade(b, samples)) for b in (brdf, reference))
    return colour_difference(found, wanted)
