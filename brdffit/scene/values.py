"""Values of a scene, checked once, with the name of the key in every complaint."""

import math
import numbers
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from jaxtyping import Float

from brdffit.types import AnyArray

Numbers: TypeAlias = float | Sequence[Any] | AnyArray  # as users write them

TOLERANCE = 1e-3  # how far from 1 the length of a direction may be
LARGEST = 1e12  # number of a place or a length, beyond which digits are lost
SIDE = 32_768  # most pixels along one side of an image
ROUNDING = 1e-15  # and within which it is as good as 1 and left as it is


def whole(key: str, value: Any, least: int, most: int | None = None) -> int:
    """A whole number, ``least`` or above, and ``most`` or below.

    Raises:
        ValueError: It is anything else.
    """
    right = isinstance(value, numbers.Integral) and not isinstance(value, bool)
    if not right or value < least:
        raise ValueError(
            f"`{key}` must be a whole number, {least} or above, but is {value!r}."
        )
    if most is not None and int(value) > most:
        raise ValueError(f"`{key}` must be {most} or below, but is {value!r:.60}.")
    return int(value)


def positive(key: str, value: Any) -> float:
    """A finite number above zero.

    Raises:
        ValueError: It is anything else.
    """
    array = finite(key, value)
    if array.ndim or not array > 0:
        raise ValueError(f"`{key}` must be one number above 0, but is {value!r}.")
    return float(array)


def share(key: str, value: Any) -> float:
    """A number from 0 to 1.

    Raises:
        ValueError: It is anything else.
    """
    array = finite(key, value)
    if array.ndim or not 0 <= array <= 1:
        raise ValueError(f"`{key}` must be a number from 0 to 1, but is {value!r}.")
    return float(array)


def size(key: str, value: Any) -> int | tuple[int, int]:
    """Rows and columns of an image: one whole number for both, or a list of the two.

    Raises:
        ValueError: It is anything else.
    """
    if isinstance(value, list | tuple) and len(value) == 2:
        rows, columns = (whole(key, number, 1, SIDE) for number in value)
        return rows, columns
    return whole(key, value, 1, SIDE)


def point(key: str, value: Any) -> Float[np.ndarray, "3"]:
    """Three numbers, none so large that digits are lost.

    Raises:
        ValueError: It is anything else.
    """
    array = finite(key, value)
    if array.shape != (3,):
        raise ValueError(f"`{key}` must be three numbers, but is {value!r}.")
    if np.any(np.abs(array) > LARGEST):
        raise ValueError(
            f"`{key}` must have no number beyond {LARGEST:g}, but is {value!r}."
        )
    return array


def length(key: str, value: Any) -> float:
    """A number above zero whose square is a number, too.

    Raises:
        ValueError: It is anything else.
    """
    found = positive(key, value)
    if not 1 / LARGEST <= found <= LARGEST:
        raise ValueError(
            f"`{key}` must lie from {1 / LARGEST:g} to {LARGEST:g}, but is {value!r}."
        )
    return found


def pair(key: str, value: Any) -> Float[np.ndarray, "2"]:
    """Two numbers above zero, or one for both.

    Raises:
        ValueError: It is anything else.
    """
    array = finite(key, value)
    if array.shape not in ((), (2,)) or np.any(array <= 0):
        raise ValueError(
            f"`{key}` must be one or two numbers above 0, but is {value!r}."
        )
    return np.broadcast_to(array, 2).copy()


def boolean(key: str, value: Any) -> bool:
    """True or False.

    Raises:
        ValueError: It is anything else.
    """
    if not isinstance(value, bool | np.bool_):
        raise ValueError(f"`{key}` must be true or false, but is {value!r}.")
    return bool(value)


def spectrum(key: str, value: Any) -> Float[np.ndarray, "..."]:
    """One number that is not negative, or a list with one for each channel.

    Raises:
        ValueError: It is anything else.
    """
    array = finite(key, value)
    if array.ndim > 1 or array.size == 0 or np.any(array < 0):
        raise ValueError(
            f"`{key}` must be a number or a list of numbers, none negative, "
            f"but is {value!r}."
        )
    return array


def angles(key: str, value: Any) -> Float[np.ndarray, " angle"]:
    """A list of one or more angles in degrees.

    Raises:
        ValueError: It is anything else.
    """
    array = np.atleast_1d(finite(key, value))
    if array.ndim > 1 or array.size == 0:
        raise ValueError(f"`{key}` must be a list of angles, but is {value!r}.")
    return array


def polar_angles(key: str, value: Any) -> Float[np.ndarray, " angle"]:
    """A list of one or more angles in degrees, all above the horizon.

    Raises:
        ValueError: It is anything else.
    """
    array = angles(key, value)
    if np.any((array < 0) | (array >= 90)):
        raise ValueError(
            f"`{key}` must lie from 0 to below 90 degrees, but is {array.tolist()}."
        )
    return array


def not_negative(key: str, value: Any) -> float:
    """A finite number, zero or above.

    Raises:
        ValueError: It is anything else.
    """
    array = finite(key, value)
    if array.ndim or array < 0:
        raise ValueError(f"`{key}` must be one number not below 0, but is {value!r}.")
    return float(array)


def unit_vector(key: str, value: Any) -> Float[np.ndarray, "3"]:
    """Three numbers of length 1; what rounding has taken from the length is restored.

    Raises:
        ValueError: It is not three numbers, or the length is off by more than 0.001.
    """
    array = point(key, value)
    length = math.hypot(*array)
    if abs(length - 1) > TOLERANCE:
        raise ValueError(
            f"`{key}` must be a unit vector, but {array.tolist()} has length "
            f"{length:.6g}."
        )
    return array if abs(length - 1) < ROUNDING else array / length


def finite(key: str, value: Any) -> Float[np.ndarray, "..."]:
    """Finite numbers, one or nested lists of them.

    Raises:
        ValueError: They are anything else.
    """
    try:
        array = np.asarray(value)
    except ValueError:  # lists of different lengths
        array = np.asarray(None)
    if array.dtype.kind not in "iuf" or not np.all(np.isfinite(array)):
        raise ValueError(f"`{key}` must consist of finite numbers, but is {value!r}.")
    return array.astype(np.float64)
