"""What was fitted: the file, its format, its samples and channels, as terms and words.

And where and with what the report was made.
"""

import datetime
import platform
from importlib.metadata import version
from pathlib import Path

from brdffit.readers import READERS, format_of, title
from brdffit.report.formulas import as_html
from brdffit.samples import Measurement, Samples
from brdffit.survey import Reciprocity, Summary, summary
from brdffit.survey.reciprocity import Evaluate

FEW = 8  # channels that are told one by one
SOFTWARE = ("brdffit", "jax", "optimistix", "equinox", "numpy")

Facts = list[tuple[str, str]]


def facts_of_data(
    data: Measurement | Samples,
    source: Path | None = None,
    evaluate: Evaluate | None = None,
) -> Facts:
    """Terms and descriptions of what was measured.

    Args:
        data: What was fitted.
        source: File or folder it was read from, if any.
        evaluate: ``f_r`` of the measured material at any directions, if that is known.

    Raises:
        OSError: The source cannot be read.
    """
    reader = READERS[format_of(source)] if source else None
    folded = getattr(reader, "RECIPROCAL", False)
    found = summary(data, evaluate, folded)
    facts = [("Name", found.name)]
    if source and reader:
        kind = "Folder" if source.is_dir() else "File"
        facts += [(kind, source.name), ("Format", title(reader))]
    facts += [
        ("Samples", _samples(found)),
        ("Channels", channels_in_words(found.channels)),
        ("Quantity", as_html(found.quantity.replace("f_r", "$f_r$"))),
        ("Light", f"{_span(found.theta_i)} from the normal, {_azimuths(found)}"),
        ("Viewer", f"{_span(found.theta_o)} from the normal"),
        ("Values", _values(found)),
        ("Errors", "known for every value" if found.sigma else "not given"),
    ]
    if found.reciprocity:
        facts.append(("Reciprocity", _reciprocity(found.reciprocity)))
    elif folded:
        facts.append(("Reciprocity", "one value for both orders of a pair"))
    return facts


def facts_of_making() -> Facts:
    """When, where and with what this is made."""
    now = datetime.datetime.now().astimezone()
    return [
        ("Made", f"{now:%d %B %Y, %H:%M} {now.tzname()}"),
        ("Machine", f"{platform.machine()}, {platform.system()}"),
        ("Python", platform.python_version()),
        *((name, version(name)) for name in SOFTWARE),
    ]


def channels_in_words(names: tuple[str, ...]) -> str:
    """Names of channels, of many only the first and the last."""
    if len(names) <= FEW:
        return ", ".join(names)
    return f"{len(names)}, from {names[0]} to {names[-1]}"


def _samples(found: Summary) -> str:
    kind = "pixels" if found.images else "pairs of directions"
    words = f"{found.samples:,} {kind}"
    if found.images:
        words += f" of {found.images} image{'s' if found.images > 1 else ''}"
    return words + (f", each under {found.lights} lights" if found.lights > 1 else "")


def _span(angles: tuple[float, float]) -> str:
    low, high = angles
    return f"{low:.3g}°" if high - low < 0.05 else f"{low:.3g}° to {high:.3g}°"


def _azimuths(found: Summary) -> str:
    return f"{found.azimuths:,} azimuth{'s' if found.azimuths > 1 else ''}"


def _values(found: Summary) -> str:
    low, high = min(found.lowest), max(found.highest)
    words = f"{found.usable:,} usable, {low:.3g} to {high:.3g}"
    return "; ".join([words, *(f"{n:,} {why}" for why, n in found.invalid.items())])


def _reciprocity(found: Reciprocity) -> str:
    near = "" if found.exact else " within a degree"
    return (
        f"{found.median:.2%} in the median between exchanged directions{near}, "
        f"{found.pairs:,} pairs"
    )
