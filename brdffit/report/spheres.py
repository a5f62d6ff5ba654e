"""Spheres of a report: what was measured, what each model shows, and the difference.

Where the data show no sphere and their format cannot be evaluated at the directions of
one, models are compared with the best, and the best with the next.
"""

import dataclasses
from collections.abc import Mapping
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from jaxtyping import Bool
from matplotlib.colors import to_hex, to_rgba
from scipy.ndimage import binary_closing, distance_transform_edt

from brdffit.models import AbstractBRDF
from brdffit.plots.spheres import exposure_of, frame_image, limit_of, on_screen
from brdffit.plots.style import DIVERGING, NO_DATA, spread
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.report.embed import embed_pixels
from brdffit.samples import Measurement, Samples
from brdffit.scene import lit_sphere
from brdffit.survey.reciprocity import Evaluate
from brdffit.types import Image, Values

MEASURED = "measured"
FRAMES = 4  # most photographs
RESOLUTION = 320  # rows and columns of rendered spheres
LARGEST = 512  # rows or columns of a photograph, beyond which every other is left out
GAP = 4  # pixels between samples that are filled
ROUND = 0.97  # share of the pixels that must agree with a disc
STOPS = 9  # colours of the scale of differences


class Surface(NamedTuple):
    """Which pixels of a frame are shown.

    Attributes:
        nearest: Row and column of the sample that each pixel takes its value from.
        shown: False where a pixel stays empty.
        disc: Whether it is a disc that fills the frame.
    """

    nearest: tuple[np.ndarray, ...]
    shown: Bool[np.ndarray, "row column"]
    disc: bool


def sphere_album(
    data: Measurement | Samples,
    models: Mapping[str, AbstractBRDF],
    evaluate: Evaluate | None = None,
) -> dict[str, Any]:
    """Pictures of the spheres as data URIs, in types that JSON knows.

    Args:
        data: What was fitted.
        models: Fitted models by name, the best first.
        evaluate: ``f_r`` of the measured material at any directions, if that is known.

    Returns:
        ``frames``, each with a title, ``pictures`` by name and ``differences`` by the
        name of the model; ``against``, what each model is compared with; the end of
        the colour scale; and whether pictures are discs, measured and photographed.
    """
    samples = _seen(data, next(iter(models.values())).channels, evaluate)
    assert samples.pixels is not None  # for the type checker
    values = {n: np.asarray(compiled_shade(b, samples)) for n, b in models.items()}
    against = _against(list(models), samples.value is not None)
    used = np.ones_like(next(iter(values.values())), bool)
    if samples.value is not None:
        used = np.isfinite(np.asarray(samples.value))
        if samples.mask is not None:
            used &= np.asarray(samples.mask)
        values[MEASURED] = np.asarray(samples.value)
    difference = {
        name: np.where(used, values[name] - values[other], np.nan)
        for name, other in against.items()
    }
    limit = limit_of(difference.values()) if difference else 1.0
    reference = values.get(MEASURED, values[next(iter(models))])
    exposure = exposure_of(reference[used])
    seen = spread(range(samples.pixels.shape[0]), FRAMES)
    one = np.ones((len(samples), 1))
    surfaces = [
        _surface(np.isfinite(frame_image(samples, one, f)[..., 0])) for f in seen
    ]
    frames = []
    for frame, surface in zip(seen, surfaces, strict=True):

        def shown(
            values: Values, frame: int = frame, surface: Surface = surface
        ) -> Image:
            image = frame_image(samples, values, frame)[surface.nearest]
            return _thinned(np.where(surface.shown[..., None], image, np.nan))

        unused = shown((~used).astype(float))
        frames.append(
            {
                "title": f"light {frame + 1}",
                "pictures": {
                    name: embed_pixels(on_screen(shown(value), exposure))
                    for name, value in values.items()
                },
                "differences": {
                    name: embed_pixels(_coloured(shown(value), limit, unused))
                    for name, value in difference.items()
                },
            }
        )
    return {
        "frames": frames,
        "against": against,
        "limit": float(f"{limit:.2g}"),
        "exposure": float(f"{exposure:.3g}"),
        "round": all(surface.disc for surface in surfaces),
        "measured": samples.value is not None,
        "photographed": isinstance(data, Samples) and data.pixels is not None,
    }


def scale_of_colours() -> list[str]:
    """Colours of the differences from the lowest to the highest, as in CSS."""
    colours = matplotlib.colormaps[DIVERGING](np.linspace(0, 1, STOPS))
    return [to_hex(colour) for colour in colours]


def _seen(
    data: Measurement | Samples, channels: int, evaluate: Evaluate | None
) -> Samples:
    """Samples of the sphere that is shown, with values where they are known."""
    if isinstance(data, Samples) and data.pixels is not None:
        return data
    samples = trace(lit_sphere(RESOLUTION), channels=channels)
    if evaluate is None:
        return samples
    f_r = evaluate(np.asarray(samples.wi[:, 0], float), np.asarray(samples.wo, float))
    value = np.maximum(f_r, 0) * np.asarray(samples.weight[:, 0])
    return dataclasses.replace(samples, value=value, mask=np.isfinite(value))


def _against(models: list[str], measured: bool) -> dict[str, str]:
    """What each model is compared with, by name; nothing where there is nothing."""
    if measured:
        return dict.fromkeys(models, MEASURED)
    best, *others = models
    return dict.fromkeys(others, best) | ({best: others[0]} if others else {})


def _coloured(difference: Image, limit: float, unused: Image) -> np.ndarray:
    """The mean of the channels in colours, grey where a pixel was not used."""
    scaled = 0.5 + 0.5 * difference.mean(axis=-1) / limit
    colours = matplotlib.colormaps[DIVERGING](np.clip(np.nan_to_num(scaled), 0, 1))
    colours[~np.isfinite(scaled)] = 0
    colours[np.any(unused > 0, axis=-1)] = to_rgba(NO_DATA)
    return np.round(255 * colours).astype(np.uint8)


def _surface(covered: Bool[np.ndarray, "row column"]) -> Surface:
    """What of a frame is shown, of which only some pixels may be samples.

    Gaps between samples are filled, and a disc is continued beyond its edge, where the
    page cuts a smooth circle.
    """
    closed = binary_closing(np.pad(covered, GAP), iterations=GAP)
    shown = closed[GAP:-GAP, GAP:-GAP] | covered
    y, x = np.indices(covered.shape)
    rows, columns = covered.shape
    disc = np.hypot((2 * x + 1) / columns - 1, (2 * y + 1) / rows - 1) <= 1
    whole = abs(rows - columns) < GAP and float(np.mean(disc == shown)) > ROUND
    nearest = distance_transform_edt(
        ~covered, return_distances=False, return_indices=True
    )
    return Surface(tuple(np.asarray(nearest)), shown | whole, whole)


def _thinned(image: Image) -> Image:
    step = -(-max(image.shape[:2]) // LARGEST)
    return image[::step, ::step]
