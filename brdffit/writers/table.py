"""Write a measurement as a table of brdffit, described in `brdffit.readers.table`."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from brdffit.files import replacing
from brdffit.samples import Measurement, default_channels
from brdffit.types import AnyArray, Mask, Values, Vectors

ROWS_AT_A_TIME = 10_000  # bounds the memory that numbers need while they are text


def save(
    measurement: Measurement,
    path: Path | str,
    comments: Mapping[str, str] | None = None,
) -> None:
    """Write ``measurement`` with its directions as vectors, exact to the last bit.

    Numbers are as short as their precision allows. The file appears under its name only
    when it is complete.

    Args:
        measurement: What to write.
        path: File to write; one that exists is replaced.
        comments: Further lines ``# key: value`` of the header, for people.

    Raises:
        ValueError: A name would break the header or its columns.
        OSError: The file cannot be written.
    """
    count, width = measurement.f_r.shape
    names = measurement.channels or default_channels(width)
    arrays = {
        **vectors("wi", measurement.wi),
        **vectors("wo", measurement.wo),
        **by_channel("", names, measurement.f_r),
        **by_channel("sigma_", names, measurement.sigma),
    }
    if measurement.solid_angle is not None:
        arrays["solid_angle"] = measurement.solid_angle
    precision = np.result_type(np.float32, *(np.asarray(a) for a in arrays.values()))
    columns = {
        **{name: np.asarray(array, precision) for name, array in arrays.items()},
        **by_channel("mask_", names, measurement.mask),
    }
    header = {
        "name": measurement.name,
        "precision": str(precision),
        "rows": str(count),
        "cosine": "not included",
        "channels": ", ".join(names),
    }
    refuse_unreadable(path, names, header, comments or {})
    header |= comments or {}
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8") as stream:
        stream.write("# brdffit table 1\n")
        stream.writelines(f"# {key}: {text}\n" for key, text in header.items() if text)
        stream.write(",".join(columns) + "\n")
        for start in range(0, count, ROWS_AT_A_TIME):
            rows = slice(start, start + ROWS_AT_A_TIME)
            words = [shortest(column[rows]) for column in columns.values()]
            stream.writelines(",".join(row) + "\n" for row in zip(*words, strict=True))


def shortest(numbers: np.ndarray) -> list[str]:
    """Each number in the fewest digits that give it back.

    The print mode is set here because a library may have changed it for the whole
    process (colour-science does), and then numpy writes twelve digits.
    """
    with np.printoptions(legacy=False):
        return numbers.astype(str).tolist()


def vectors(name: str, directions: Vectors) -> dict[str, AnyArray]:
    """Columns of a direction."""
    return {f"{name}_{axis}": directions[:, i] for i, axis in enumerate("xyz")}


def by_channel(
    prefix: str, names: tuple[str, ...], values: Values | Mask | None
) -> dict[str, np.ndarray]:
    """Columns of values, one for each channel; none when there are no values."""
    if values is None:
        return {}
    array = np.asarray(values)
    array = array.astype(np.int8) if array.dtype == bool else array
    return {prefix + name: array[:, i] for i, name in enumerate(names)}


def refuse_unreadable(
    path: Path | str,
    names: tuple[str, ...],
    header: Mapping[str, str],
    comments: Mapping[str, str],
) -> None:
    """Refuse names that would break the header or the line of column names."""
    columns = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z", "solid_angle", ""}
    spoiled = [
        name for name in names if name != name.strip() or set(name) & set(",#\n")
    ]
    if spoiled or columns & set(names) or len(set(names)) < len(names):
        raise ValueError(
            f"Channels of table `{path}` must have names of their own without commas, "
            f"`#` or line breaks, but are {list(names)}."
        )
    for key, text in [*header.items(), *comments.items()]:
        if len(f"{key}: {text}".splitlines()) != 1 or ":" in key:
            raise ValueError(
                f"`{key}` in the header of table `{path}` must fit on one line."
            )
    if taken := header.keys() & comments.keys():
        raise ValueError(
            f"Comment `{taken.pop()}` of table `{path}` has the name of a line that "
            f"the header needs; rename it."
        )
