"""A measurement in another format: our table, MERL binary, or an image of a sphere."""

import dataclasses
from pathlib import Path
from types import ModuleType

import numpy as np

from brdffit import half_difference
from brdffit.readers import READERS, format_of
from brdffit.render import trace
from brdffit.samples import Measurement, Samples, pick_channels
from brdffit.scene import lit_sphere
from brdffit.spectrum import to_rgb
from brdffit.types import Values, Vectors
from brdffit.writers import merl, sphere, table

RESOLUTION = 256  # of an image
SUFFIXES = (".csv", ".binary", ".exr")


def convert(
    source: Path,
    data: Measurement | Samples,
    path: Path,
    illuminant: str | None = None,
) -> str:
    """Write data that were read from a file in the format that a suffix names.

    Args:
        source: Where the data come from, which can be asked for other directions when
            its format can be evaluated anywhere.
        data: What was read.
        path: ``.csv`` for a table of brdffit, ``.binary`` for MERL, ``.exr`` for an
            image of a sphere of the material under one light, with its scene beside it.
        illuminant: Light under which the data became RGB, if they were spectral.

    Returns:
        What was written, as a sentence.

    Raises:
        ValueError: The format is not known, or cannot hold these data.
        OSError: A file cannot be written.
    """
    reader = READERS[format_of(source)]
    suffix = path.suffix.lower()
    if suffix == ".csv":
        rows = measurement(data)
        table.save(rows, path, {"origin": f"converted from {source.name}"})
        return f"Written {len(rows)} pairs of directions as a table."
    if suffix == ".binary":
        merl.save(on_cells(source, data, reader, illuminant), path)
        return f"Written {half_difference.COUNT} cells as MERL binary."
    if suffix == ".exr":
        scene = lit_sphere(RESOLUTION)
        image = photographed(source, data, reader, illuminant)
        sphere.save(image, scene, path, {"measured": data.name})
        return f"Written a sphere of {len(image)} pixels under one light."
    raise ValueError(f"File `{path}` must end in {', '.join(SUFFIXES)}.")


def measurement(data: Measurement | Samples) -> Measurement:
    """Pairs of directions with f_r; pixels become pairs when one light shines on each.

    Raises:
        ValueError: Several lights shine on a pixel.
    """
    if isinstance(data, Measurement):
        return data
    f_r = data.f_r.astype(np.float64)
    lit = np.asarray(data.weight[:, 0]) > 0
    mask = np.isfinite(f_r) & lit
    if data.mask is not None:
        mask &= np.asarray(data.mask)
    sigma = data.sigma
    if sigma is not None:
        sigma = np.asarray(sigma) / np.where(lit, data.weight[:, 0], 1)
    return Measurement(
        wi=np.asarray(data.wi[:, 0], np.float64),
        wo=np.asarray(data.wo, np.float64),
        f_r=f_r,
        sigma=sigma,
        mask=mask,
        channels=data.channels,
        name=data.name,
    )


def on_cells(
    source: Path,
    data: Measurement | Samples,
    reader: ModuleType,
    illuminant: str | None = None,
) -> Measurement:
    """The material at the cells of a MERL file.

    Cells with a direction nearer to the horizon than any measured light have no data.

    Raises:
        ValueError: It is known at other directions only.
    """
    if isinstance(data, Measurement) and merl.on_grid(data):
        return data
    wi, wo, _ = half_difference.cells()
    lowest = np.asarray(data.wi)[..., 2].min()  # beyond which nothing was measured
    above = (wi[:, 2] >= lowest) & (wo[:, 2] >= lowest) & (wi[:, 2] > 0)
    f_r = np.zeros((len(wi), len(data.channels)))
    f_r[above] = evaluated(source, data, reader, wi[above], wo[above], illuminant)
    mask = above[:, None] & (f_r >= 0)
    return Measurement(wi, wo, f_r, mask=mask, name=data.name)


def photographed(
    source: Path,
    data: Measurement | Samples,
    reader: ModuleType,
    illuminant: str | None = None,
) -> Samples:
    """The material as the image of a sphere.

    Raises:
        ValueError: It is known at other directions only.
    """
    samples = trace(lit_sphere(RESOLUTION), channels=len(data.channels))
    wi, wo = np.asarray(samples.wi[:, 0], float), np.asarray(samples.wo, float)
    f_r = evaluated(source, data, reader, wi, wo, illuminant)
    value = (f_r * np.asarray(samples.weight[:, 0])).astype(np.float32)
    return dataclasses.replace(samples, value=value, channels=data.channels)


def evaluated(
    source: Path,
    data: Measurement | Samples,
    reader: ModuleType,
    wi: Vectors,
    wo: Vectors,
    illuminant: str | None = None,
) -> Values:
    """f_r of the material in a file at any directions, in the channels of the data.

    Raises:
        ValueError: Its format holds single pairs of directions.
    """
    if not hasattr(reader, "evaluate"):
        raise ValueError(
            f"`{source}` holds f_r at {len(data)} directions of its own, which do not "
            f"fill a grid or an image: fit a model and export that, or convert to .csv."
        )
    f_r = reader.evaluate(source, wi, wo)
    channels = reader.load(source).channels
    anywhere = Measurement(wi, wo, f_r, channels=channels)
    if illuminant:
        anywhere = to_rgb(anywhere, illuminant)
    chosen = pick_channels(anywhere, data.channels)
    assert isinstance(chosen, Measurement)  # for the type checker
    return np.asarray(chosen.f_r)
