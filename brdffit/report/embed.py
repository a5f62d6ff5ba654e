"""Pictures inside a page: compressed, as data URIs."""

import base64
import io

import matplotlib
import numpy as np
from jaxtyping import UInt8
from matplotlib.figure import Figure
from matplotlib.image import imsave

from brdffit.plots.style import LOOK

RESOLUTION = 200  # dots per inch of a figure
PIXELS = {"quality": 90, "method": 3}  # of photographs and renders
LINES = {"lossless": True, "quality": 20, "method": 2}


def embed_pixels(pixels: UInt8[np.ndarray, "row column 4"]) -> str:
    """Data URI of an image with opacity."""
    stream = io.BytesIO()
    imsave(stream, pixels, format="webp", pil_kwargs=dict(PIXELS))
    return _uri(stream)


def embed_figure(figure: Figure) -> str:
    """Data URI of a figure without background, so that it lies on any page."""
    stream = io.BytesIO()
    with matplotlib.rc_context(LOOK):
        figure.savefig(
            stream,
            format="webp",
            dpi=RESOLUTION,
            transparent=True,
            pil_kwargs=dict(LINES),
        )
    return _uri(stream)


def _uri(stream: io.BytesIO) -> str:
    return "data:image/webp;base64," + base64.b64encode(stream.getvalue()).decode()
