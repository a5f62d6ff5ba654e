"""Options that several commands share, and how their words are understood."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit

ALL = "all"

Json = Annotated[
    bool, Parameter("--json", help="Print the outcome as JSON instead of tables.")
]
Out = Annotated[
    Path | None, Parameter("--out", help="Folder for results and pictures.")
]
Report = Annotated[
    bool,
    Parameter(
        "--report", help="Also write report.html, one file, into --out or this folder."
    ),
]
Channels = Annotated[
    str | None,
    Parameter("--channels", help="Names of the channels to use, as in R,G."),
]
Illuminant = Annotated[
    str | None,
    Parameter(
        "--illuminant",
        help="Light under which spectral data become RGB, as D65; else as they are.",
    ),
]
Share = Annotated[
    int | None,
    Parameter(
        "--samples",
        help="Use a random share of so many samples that stands for all. [all]",
    ),
]
Settings = Annotated[
    tuple[str, ...],
    Parameter(
        "--set",
        consume_multiple=1,
        help="Parameters, as in alpha=0.2 albedo=0.8,0.5,0.2.",
    ),
]
SceneFile = Annotated[
    Path | None,
    Parameter("--scene", help="Scene, a TOML file; by default a lit sphere."),
]
Lights = Annotated[
    int | None,
    Parameter("--lights", help="Lights on the default sphere, shining together. [1]"),
]
Resolution = Annotated[
    int | None,
    Parameter("--resolution", help="Rows and columns of the default sphere. [256]"),
]

Resume = Annotated[
    bool,
    Parameter(
        "--resume",
        help="Go on with an earlier run in that folder, and keep what is finished.",
    ),
]
Cluster = Annotated[
    str | None,
    Parameter(
        "--cluster",
        help="Address of a Dask scheduler, as in tcp://host:8786. [threads here]",
    ),
]
Tolerance = Annotated[
    float | None,
    Parameter("--tolerance", help="Relative error that effects may leave. [0.001]"),
]
With = Annotated[
    tuple[str, ...],
    Parameter("--with", consume_multiple=1, help="Effects to simulate in any case."),
]
Without = Annotated[
    tuple[str, ...],
    Parameter(
        "--without", consume_multiple=1, help="Effects to leave out in any case."
    ),
]
Within = Annotated[
    str,
    Parameter(
        "--within",
        help="Parameters to plan for: given, or the worst of typical or bounds. "
        "[given]",
    ),
]


def chosen_models(text: str) -> list[str]:
    """Names between commas, or those of the whole catalogue for ``all``."""
    return list(brdffit.MODELS) if text == ALL else words(text)


def words(text: str) -> list[str]:
    """The parts between commas."""
    return [word.strip() for word in text.split(",") if word.strip()]


def numbers(text: str, option: str) -> list[float]:
    """Numbers between commas.

    Raises:
        ValueError: Something else stands there.
    """
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        raise ValueError(
            f"Option {option} must be given numbers with commas between them, "
            f"but is given `{text}`."
        ) from None


def assignments(given: Sequence[str], option: str) -> dict[str, list[float]]:
    """The numbers given to each name by words such as ``albedo=0.8,0.5,0.2``.

    Raises:
        ValueError: A word is not of this form.
    """
    found = {}
    for word in given:
        name, sign, text = word.partition("=")
        if not sign:
            raise ValueError(
                f"Option {option} must be given name=value, but is given `{word}`."
            )
        found[name] = numbers(text, f"{option} {name}")
    return found


def refuse(out: Path, options: Mapping[str, object]) -> None:
    """Refuse options that say nothing about this kind of output.

    Raises:
        ValueError: One of them is given.
    """
    for option, value in options.items():
        if value is not None:
            raise ValueError(f"Option {option} says nothing about a {out.suffix} file.")
