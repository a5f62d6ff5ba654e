"""Tensor files: named arrays, the container of the RGL material database.

``tensor_file``, a zero byte, two bytes of version and the number of fields; then for
each field the length of its name, the name, the number of dimensions, the type, the
offset of its data from the start of the file and the size of each dimension. All is
little-endian.
"""

import math
import struct
from pathlib import Path

import numpy as np

MAGIC = b"tensor_file\0"
TYPES = (
    None,
    "u1",
    "i1",
    "<u2",
    "<i2",
    "<u4",
    "<i4",
    "<u8",
    "<i8",
    "<f2",
    "<f4",
    "<f8",
)
MOST_DIMENSIONS = 16


def read(path: Path | str) -> dict[str, np.ndarray]:
    """The arrays of a tensor file by name, as views of its bytes.

    Raises:
        ValueError: The file is no tensor file, or cut off.
        OSError: The file cannot be read.
    """
    content = Path(path).read_bytes()
    if not content.startswith(MAGIC):
        raise ValueError(f"`{path}` is not a tensor file.")
    try:
        major, minor, count = struct.unpack_from("<BBI", content, len(MAGIC))
        if (major, minor) != (1, 0):
            raise ValueError(
                f"Tensor file `{path}` has version {major}.{minor}; only 1.0 is known."
            )
        position, fields = len(MAGIC) + 6, {}
        for _ in range(count):
            name, field, position = read_field(content, position)
            fields[name] = field
    except (struct.error, IndexError, UnicodeDecodeError, OverflowError) as error:
        raise ValueError(
            f"The list of arrays in tensor file `{path}` is damaged or cut off."
        ) from error
    whole = {}
    for name, (dtype, offset, shape) in fields.items():
        size = math.prod(shape) * dtype.itemsize
        if offset + size > len(content):
            raise ValueError(
                f"Tensor file `{path}` is cut off: array `{name}` should end at byte "
                f"{offset + size}, but the file at {len(content)}."
            )
        flat = np.frombuffer(content, dtype, math.prod(shape), offset)
        whole[name] = flat.reshape(shape)
    return whole


def read_field(
    content: bytes, position: int
) -> tuple[str, tuple[np.dtype, int, tuple[int, ...]], int]:
    """Name of a field, its type, offset and shape, and where the next field begins."""
    (length,) = struct.unpack_from("<H", content, position)
    position += 2
    name = content[position : position + length].decode()
    position += length
    dimensions, kind, offset = struct.unpack_from("<HBQ", content, position)
    position += 11
    if dimensions > MOST_DIMENSIONS or kind == 0 or not name.isidentifier():
        raise IndexError
    shape = struct.unpack_from(f"<{dimensions}Q", content, position)
    return name, (np.dtype(TYPES[kind]), offset, shape), position + 8 * dimensions
