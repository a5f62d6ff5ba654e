"""From the words of a user to data and to a BRDF."""

import dataclasses
from collections.abc import Mapping, Sequence
from operator import attrgetter
from pathlib import Path

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from brdffit.catalogue import from_name
from brdffit.cli.options import words
from brdffit.fit import load_result
from brdffit.models import AbstractBRDF
from brdffit.models.base import RGB
from brdffit.names import look_up
from brdffit.parameters import check, registry_name, replace, spectral_fields
from brdffit.readers import load
from brdffit.samples import Measurement, Samples
from brdffit.scene import Scene, lit_sphere, load_scene
from brdffit.scene.values import whole

FIRST_LIGHT = (-0.48, 0.6, 0.64)  # upper left


def read_data(
    path: Path,
    channels: str | None = None,
    illuminant: str | None = None,
    samples: int | None = None,
) -> Measurement | Samples:
    """A measurement as the options of a command ask for it.

    Args:
        path: File or folder.
        channels: Names of the channels to use, with commas between them; all by
            default.
        illuminant: Light under which spectral data become RGB.
        samples: Number of samples of a share that stands for all.

    Raises:
        ValueError: The content is wrong, or there is no such channel.
        OSError: The file cannot be read.
    """
    picked = words(channels or "")
    return load(path, channels=picked, illuminant=illuminant, samples=samples)


def saved_or_named(
    source: str,
    given: Mapping[str, Sequence[float]],
    channels: int | None = None,
) -> AbstractBRDF:
    """The model of a saved result, or one of the catalogue, with parameters changed.

    Args:
        source: File written by `FitResult.save`, or name of a model or of a sum.
        given: One number, or one for each channel, by the name of the parameter.
        channels: Number of channels of a named model; by default as many as the lists
            in ``given`` have, or three.

    Raises:
        ValueError: No such model or parameter, a value outside its interval, or a list
            of another length.
        OSError: The file cannot be read.
    """
    if Path(source).suffix == ".json" or Path(source).is_file():
        return adjusted(load_result(source).brdf, given)
    longest = max((len(value) for value in given.values()), default=1)
    wanted = channels or (longest if longest > 1 else RGB)
    return adjusted(from_name(source, wanted), given)


def saved_channels(source: str) -> tuple[str, ...]:
    """Names of the channels of a saved result; none for the name of a model."""
    if Path(source).suffix == ".json" or Path(source).is_file():
        return load_result(source).channels
    return ()


def adjusted(brdf: AbstractBRDF, given: Mapping[str, Sequence[float]]) -> AbstractBRDF:
    """A model with some of its parameters changed.

    Raises:
        ValueError: No such parameter, a value outside its interval, or a list of
            another length than the model has channels.
    """
    kind, spectral, new = registry_name(brdf), settable(brdf), {}
    for name, value in given.items():
        wide = look_up(spectral, name, "Parameter")
        if len(value) != 1 and not (wide and len(value) == brdf.channels):
            wanted = f"1 or {brdf.channels} numbers" if wide else "one number"
            raise ValueError(
                f"Parameter `{name}` of `{kind}` must be {wanted}, but "
                f"{len(value)} are given."
            )
        numbers = jnp.asarray(value if wide else value[0], float)
        new[name] = jnp.broadcast_to(numbers, attrgetter(name)(brdf).shape)
    changed = replace(brdf, new)
    check(changed)
    return changed


def scene_or_sphere(
    file: Path | None, lights: int | None, resolution: int | None
) -> Scene:
    """The scene of a file, or a sphere with lights evenly spread around the viewer.

    Raises:
        ValueError: The file is wrong, or a number is, or both are given.
        OSError: The file cannot be read.
    """
    if file is not None:
        if lights is not None or resolution is not None:
            raise ValueError(
                f"Scene `{file}` has its own lights and resolution: leave out --lights "
                "and --resolution."
            )
        return load_scene(file)
    count = whole("--lights", 1 if lights is None else lights, least=1)
    turns = np.arange(count) * 2 * np.pi / count
    x, y, z = FIRST_LIGHT
    directions = [
        (x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z)
        for turn in turns
    ]
    return lit_sphere(256 if resolution is None else resolution, directions)


def settable(brdf: eqx.Module) -> dict[str, bool]:
    """Every number of a model by dotted name: True for one per channel."""
    found = dict(spectral_fields(brdf))
    for field in dataclasses.fields(brdf):
        if isinstance(part := getattr(brdf, field.name), eqx.Module):
            found |= {f"{field.name}.{n}": wide for n, wide in settable(part).items()}
    return found
