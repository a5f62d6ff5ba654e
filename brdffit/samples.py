"""Samples: what every reader and every geometry pass returns and every fit consumes.

Arrays keep the precision of their file and may be numpy's or jax's; nothing here
computes.
"""

import dataclasses
from collections.abc import Sequence
from typing import Any, TypeVar

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit.names import look_up
from brdffit.types import AnyArray, Index, Mask, Values, Vectors

Data = TypeVar("Data", bound="Samples | Measurement")


class Pixels(eqx.Module):
    """Where samples lie in a stack of images: frame, row and column of each."""

    frame: Index
    row: Index
    column: Index
    shape: tuple[int, int, int] = eqx.field(static=True)  # frames, rows, columns

    def images(self, values: Values, background: float = np.nan) -> np.ndarray:
        """``values (N, C)`` as images ``(frames, rows, columns, C)``."""
        canvas = np.full((*self.shape, values.shape[1]), background, np.float32)
        canvas[self.frame, self.row, self.column] = values
        return canvas


class Samples(eqx.Module):
    """Directions with weights, and what was observed there.

    The value of a sample is ``sum over lights of f_r(wi, wo) weight``, and with ambient
    light ``diffuse_reflectance ambient`` more.

    Attributes:
        wi: Directions to the lights, in the local frame of each sample.
        wo: Direction to the viewer, in the same frame.
        weight: What a unit of ``f_r`` adds to the value, per light and channel: light,
            cosine, visibility, falloff, exposure.
        cosine: The cosine that a residual multiplies with: that of ``wi`` where values
            are reflectance, 1 where they are radiance, whose weight holds it already.
        value: Observation, or None for a scene that is still to be rendered.
        sigma: Standard deviation of each value, or None when unknown.
        mask: False where a value is invalid or saturated and must not be used.
        solid_angle: Share of the domain that each sample stands for, or None.
        channels: Name of each channel.
        pixels: Where the samples lie in images, or None for a goniometer.
        name: What was measured.
        ambient: What a unit of diffuse reflectance adds to each value, or None.
    """

    wi: Float[AnyArray, "sample light 3"]
    wo: Vectors
    weight: Float[AnyArray, "sample light channel"]
    cosine: Float[AnyArray, " sample"]
    value: Values | None = None
    sigma: Values | None = None
    mask: Mask | None = None
    solid_angle: Float[AnyArray, " sample"] | None = None
    channels: tuple[str, ...] = eqx.field(static=True, default=())
    pixels: Pixels | None = None
    name: str = eqx.field(static=True, default="")
    ambient: Values | None = None

    def __len__(self) -> int:
        return self.wo.shape[0]

    @property
    def f_r(self) -> np.ndarray:
        """Reflectance ``value / weight`` of samples lit by one light each.

        Raises:
            ValueError: Several lights, or no value.
        """
        if self.value is None or self.wi.shape[1] != 1:
            raise ValueError(
                f"Samples `{self.name}` must have one light and a value to speak of "
                f"f_r, but have {self.wi.shape[1]} lights"
                f"{' and no value' if self.value is None else ''}."
            )
        weight = np.asarray(self.weight[:, 0])
        safe = np.where(weight > 0, weight, 1)
        return np.where(weight > 0, np.asarray(self.value) / safe, np.nan)

    def take(self, rows: np.ndarray) -> "Samples":
        """The samples with these indices, or where a Boolean array is True."""

        def pick(array: Any) -> Any:
            return None if array is None else array[rows]

        where = self.pixels and Pixels(
            pick(self.pixels.frame),
            pick(self.pixels.row),
            pick(self.pixels.column),
            self.pixels.shape,
        )
        arrays = ("wi", "wo", "weight", "cosine", "value", "sigma", "mask", "ambient")
        return dataclasses.replace(
            self,
            **{name: pick(getattr(self, name)) for name in arrays},
            solid_angle=pick(self.solid_angle),
            pixels=where,
        )


class Measurement(eqx.Module):
    """Measured reflectance: one direction in, one direction out, ``f_r`` in 1/sr.

    Attributes:
        wi: Directions to the light.
        wo: Directions to the viewer.
        f_r: Reflectance without the cosine of the incident angle.
        sigma: Standard deviation of each ``f_r``, or None when unknown.
        mask: False where a value is invalid and must not be used, or None.
        solid_angle: Share of the domain that each sample stands for, or None.
        channels: Name of each channel.
        name: What was measured.
    """

    wi: Vectors
    wo: Vectors
    f_r: Values
    sigma: Values | None = None
    mask: Mask | None = None
    solid_angle: Float[AnyArray, " sample"] | None = None
    channels: tuple[str, ...] = eqx.field(static=True, default=())
    name: str = eqx.field(static=True, default="")

    def __len__(self) -> int:
        return self.wo.shape[0]


def as_samples(data: Samples | Measurement) -> Samples:
    """A measurement as samples with one light of unit weight; samples unchanged."""
    if isinstance(data, Samples):
        return data
    count, channels = data.f_r.shape
    return Samples(
        wi=data.wi[:, None],
        wo=data.wo,
        weight=np.ones((count, 1, channels), np.asarray(data.f_r).dtype),
        cosine=data.wi[:, 2],
        value=data.f_r,
        sigma=data.sigma,
        mask=data.mask,
        solid_angle=data.solid_angle,
        channels=data.channels or default_channels(channels),
        name=data.name,
    )


def join(parts: Sequence[Samples]) -> Samples:
    """Samples of several images as one; frames of each follow those of the one before.

    All must have the same number of lights and channels and the same size of image.
    """
    first = parts[0]

    def together(name: str) -> np.ndarray | None:
        arrays = [getattr(part, name) for part in parts]
        return None if arrays[0] is None else np.concatenate(arrays)

    names = ("wi", "wo", "weight", "cosine", "value", "sigma", "mask", "solid_angle")
    names += ("ambient",)
    pixels = [part.pixels for part in parts if part.pixels is not None]
    frames = np.cumsum([0, *(where.shape[0] for where in pixels)])
    shifted = [
        where.frame + start for where, start in zip(pixels, frames, strict=False)
    ]
    where = pixels and Pixels(
        np.concatenate(shifted),
        np.concatenate([where.row for where in pixels]),
        np.concatenate([where.column for where in pixels]),
        (int(frames[-1]), *pixels[0].shape[1:]),
    )
    return dataclasses.replace(
        first, **{name: together(name) for name in names}, pixels=where or None
    )


def pick_channels(data: Data, names: Sequence[str]) -> Data:
    """The data in some of their channels, in the order asked for.

    Raises:
        ValueError: There is no such channel.
    """
    arrays = ("f_r",) if isinstance(data, Measurement) else ("weight", "value")
    known = data.channels or default_channels(getattr(data, arrays[-1]).shape[-1])
    places = {name: place for place, name in enumerate(known)}
    picked = [look_up(places, name, "Channel") for name in names]
    new = {
        name: array[..., picked]
        for name in (*arrays, "sigma", "mask", "ambient")
        if (array := getattr(data, name, None)) is not None
    }
    return dataclasses.replace(data, **new, channels=tuple(names))


def default_channels(count: int) -> tuple[str, ...]:
    """Names of channels when a file gives none: RGB for three, numbers otherwise."""
    return ("R", "G", "B") if count == 3 else tuple(str(c) for c in range(count))
