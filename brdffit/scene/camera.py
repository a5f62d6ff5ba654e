"""Cameras: where the ray of each pixel starts and where it goes.

The world is right-handed with y up. Rays pass through the centres of pixels; row 0 is
the top of the image.
"""

from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Float, Int

from brdffit.scene import values

Rays = Float[np.ndarray, "pixel 3"]
Vector = Float[np.ndarray, "3"]
Some = slice | Int[np.ndarray, " pixel"]

ALL = slice(None)

ORIGIN = (0.0, 0.0, 0.0)
UP = (0.0, 1.0, 0.0)
FAR = 1000.0  # where parallel rays start, before what they are to meet


class Parallel(NamedTuple):
    """Rays of one direction, with places of numpy or of JAX."""

    middle: Any
    right: Any
    up: Any
    forward: Any

    def ray(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Origins and unit directions of rays through places ``(..., 1)``."""
        origin = self.middle + x * self.right + y * self.up
        xp = origin.__array_namespace__()
        return origin, xp.broadcast_to(self.forward, origin.shape)


class Pinhole(NamedTuple):
    """Rays from one point, with places of numpy or of JAX."""

    position: Any
    right: Any
    up: Any
    forward: Any

    def ray(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Origins and unit directions of rays through places ``(..., 1)``."""
        away = self.forward + x * self.right + y * self.up
        xp = away.__array_namespace__()
        length = xp.sqrt((away * away).sum(axis=-1, keepdims=True))
        return xp.broadcast_to(self.position, away.shape), away / length


class Orthographic(eqx.Module):
    """Parallel rays; by default along -z onto the square from -1 to 1 in x and y.

    So a unit sphere at the origin fills the frame. The viewer is at infinity.

    Attributes:
        resolution: Rows and columns of the image, one number when they are equal.
        towards: Unit vector from what is seen towards the viewer.
        target: Point in the centre of the image.
        up: What is up in the image; need not be perpendicular to ``towards``.
        height: Of the image, in the unit of the world.

    Raises:
        ValueError: A value is out of range, or up is the direction of view.
    """

    resolution: int | tuple[int, int] = eqx.field(
        static=True, converter=partial(values.size, "resolution")
    )
    towards: Vector = eqx.field(
        default=(0.0, 0.0, 1.0), converter=partial(values.unit_vector, "towards")
    )
    target: Vector = eqx.field(
        default=ORIGIN, converter=partial(values.point, "target")
    )
    up: Vector = eqx.field(default=UP, converter=partial(values.point, "up"))
    height: float = eqx.field(default=2.0, converter=partial(values.length, "height"))

    def __check_init__(self) -> None:
        """Refuse an image that has no upright."""
        _axes(self.towards, self.up)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the image."""
        return _shape(self.resolution)

    @property
    def lens(self) -> Parallel:
        """From places in the image to rays."""
        right, up = (self.height / 2 * axis for axis in _axes(self.towards, self.up))
        middle = self.target + FAR * self.towards
        return Parallel(middle, right, up, -self.towards)

    def rays(self, pixels: Some = ALL) -> tuple[Rays, Rays]:
        """Origin and unit direction of the ray of each pixel, or of some.

        Args:
            pixels: Which, counted row by row from the top left.
        """
        return _rays(self, pixels)


class Perspective(eqx.Module):
    """Rays from one point, as those of a pinhole camera.

    Attributes:
        resolution: Rows and columns of the image, one number when they are equal.
        position: Where all rays start.
        target: Point in the centre of the image.
        up: What is up in the image; need not be perpendicular to the direction of view.
        field_of_view: Angle from the top of the image to its bottom, in degrees.

    Raises:
        ValueError: A value is out of range, position and target are the same point, or
            up is the direction of view.
    """

    resolution: int | tuple[int, int] = eqx.field(
        static=True, converter=partial(values.size, "resolution")
    )
    position: Vector = eqx.field(converter=partial(values.point, "position"))
    target: Vector = eqx.field(
        default=ORIGIN, converter=partial(values.point, "target")
    )
    up: Vector = eqx.field(default=UP, converter=partial(values.point, "up"))
    field_of_view: float = eqx.field(
        default=40.0, converter=partial(values.positive, "field_of_view")
    )

    def __check_init__(self) -> None:
        """Refuse a camera that looks nowhere."""
        if self.field_of_view >= 180:
            raise ValueError(
                "`field_of_view` must lie between 0 and 180 degrees, but is "
                f"{self.field_of_view:g}."
            )
        if np.array_equal(self.position, self.target):
            raise ValueError(
                "`target` must be another point than `position`, but both are "
                f"{self.position.tolist()}."
            )
        _axes(self._towards, self.up)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the image."""
        return _shape(self.resolution)

    @property
    def _towards(self) -> Vector:
        back = self.position - self.target
        return back / np.linalg.norm(back)

    @property
    def lens(self) -> Pinhole:
        """From places in the image to rays."""
        half = np.tan(np.radians(self.field_of_view) / 2)
        right, up = (half * axis for axis in _axes(self._towards, self.up))
        return Pinhole(self.position, right, up, -self._towards)

    def rays(self, pixels: Some = ALL) -> tuple[Rays, Rays]:
        """Origin and unit direction of the ray of each pixel, or of some.

        Args:
            pixels: Which, counted row by row from the top left.
        """
        return _rays(self, pixels)


Camera = Orthographic | Perspective


def _rays(camera: Camera, pixels: Some) -> tuple[Rays, Rays]:
    rows, columns = camera.shape
    if isinstance(pixels, slice):
        pixels = np.arange(*pixels.indices(rows * columns))
    return camera.lens.ray(*places(camera.shape, pixels))


def _shape(resolution: int | tuple[int, int]) -> tuple[int, int]:
    return resolution if isinstance(resolution, tuple) else (resolution, resolution)


def places(shape: tuple[Any, Any], pixels: Any) -> tuple[Any, Any]:
    """Centres ``(..., 1)`` of pixels: x to the right, y from 1 at the top to -1.

    Args:
        shape: Rows and columns of the image.
        pixels: Which, counted row by row; of numpy or of JAX.
    """
    rows, columns = shape
    xp = pixels.__array_namespace__()
    row = xp.floor((pixels + 0.5) / columns)
    column = pixels - row * columns
    x, y = (2 * column + 1 - columns) / rows, 1 - (2 * row + 1) / rows
    return x[..., None], y[..., None]


def _axes(towards: Vector, up: Vector) -> tuple[Vector, Vector]:
    """Unit vectors to the right and up in the image."""
    right = np.cross(up, towards)
    length = np.linalg.norm(right)
    if length <= 1e-9 * np.linalg.norm(up):
        raise ValueError(
            f"`up` must not be the direction of view, but is {up.tolist()}."
        )
    right = right / length
    return right, np.cross(towards, right)
