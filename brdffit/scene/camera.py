"""Cameras: where the ray of each pixel starts and where it goes.

The world is right-handed with y up. Rays pass through the centres of pixels; row 0 is
the top of the image.
"""

from functools import partial

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
    height: float = eqx.field(default=2.0, converter=partial(values.positive, "height"))

    def __check_init__(self) -> None:
        """Refuse an image that has no upright."""
        _axes(self.towards, self.up)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the image."""
        return _shape(self.resolution)

    def rays(self, pixels: Some = ALL) -> tuple[Rays, Rays]:
        """Origin and unit direction of the ray of each pixel, or of some.

        Args:
            pixels: Which, counted row by row from the top left.
        """
        right, up = _axes(self.towards, self.up)
        x, y = (self.height / 2 * across for across in _plane(self.shape, pixels))
        origin = self.target + FAR * self.towards + x * right + y * up
        return origin, np.broadcast_to(-self.towards, origin.shape)


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

    def rays(self, pixels: Some = ALL) -> tuple[Rays, Rays]:
        """Origin and unit direction of the ray of each pixel, or of some.

        Args:
            pixels: Which, counted row by row from the top left.
        """
        right, up = _axes(self._towards, self.up)
        half = np.tan(np.radians(self.field_of_view) / 2)
        x, y = (half * across for across in _plane(self.shape, pixels))
        direction = x * right + y * up - self._towards
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        return np.broadcast_to(self.position, direction.shape), direction


Camera = Orthographic | Perspective


def _shape(resolution: int | tuple[int, int]) -> tuple[int, int]:
    return resolution if isinstance(resolution, tuple) else (resolution, resolution)


def _plane(shape: tuple[int, int], pixels: Some) -> tuple[np.ndarray, np.ndarray]:
    """Place ``(pixel, 1)`` of pixel centres, up and down from -1 to 1, row by row."""
    rows, columns = shape
    if isinstance(pixels, slice):
        pixels = np.arange(*pixels.indices(rows * columns))
    row, column = np.divmod(pixels[:, None], columns)
    return (2 * column + 1 - columns) / rows, -((2 * row + 1) / rows - 1)


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
