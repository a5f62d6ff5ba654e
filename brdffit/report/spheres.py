"""Spheres of a report: what was measured, what each model shows, and the difference.

Where the data show no sphere and their format cannot be evaluated at the directions of
one, models are compared with the best, and the best with the next.
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

import matplotlib
import numpy as np
from jaxtyping import Bool
from matplotlib.colors import to_hex, to_rgba
from scipy.ndimage import distance_transform_edt

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
ROUND = 0.97  # share of the pixels that must agree with a disc
STOPS = 9  # colours of the scale of differences


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
    outwards = _outwards(np.isfinite(frame_image(samples, used * 1.0, 0)[..., 0]))
    frames = []
    for frame in spread(range(samples.pixels.shape[0]), FRAMES):
        here = (np.asarray(samples.pixels.frame) == frame)[:, None]
        exposure = exposure_of(reference[used & here])

        def shown(seen: Values, frame: int = frame) -> Image:
            image = frame_image(samples, seen, frame)
            return _thinned(image[outwards] if outwards else image)

        unused = shown((~used).astype(float))
        frames.append(
            {
                "title": f"light {frame + 1}",
                "exposure": float(f"{exposure:.3g}"),
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
        "round": outwards is not None,
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


def _outwards(
    covered: Bool[np.ndarray, "row column"],
) -> tuple[np.ndarray, ...] | None:
    """Nearest covered pixel of each, by which a disc is continued beyond its edge.

    The page then cuts a smooth circle. None where the picture shows no disc.
    """
    y, x = np.indices(covered.shape)
    rows, columns = covered.shape
    disc = np.hypot((2 * x + 1) / columns - 1, (2 * y + 1) / rows - 1) <= 1
    if rows != columns or np.mean(disc == covered) < ROUND:
        return None
    nearest = distance_transform_edt(
        ~covered, return_distances=False, return_indices=True
    )
    return tuple(np.asarray(nearest))


def _thinned(image: Image) -> Image:
    step = -(-max(image.shape[:2]) // LARGEST)
    return image[::step, ::step]
