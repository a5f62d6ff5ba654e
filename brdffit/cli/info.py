"""``brdffit info``: what a file of measured reflectance holds."""

from pathlib import Path
from typing import TYPE_CHECKING

from brdffit.cli import console
from brdffit.cli.options import Channels, Illuminant, Json, Out

if TYPE_CHECKING:
    from brdffit.survey import Summary

FEW = 8  # channels that are told one by one


def info(
    data: Path,
    /,
    *,
    channels: Channels = None,
    illuminant: Illuminant = None,
    out: Out = None,
    as_json: Json = False,
) -> None:
    """Say what a file holds: format, directions, channels, range, invalid values.

    Also how reciprocal the data are. With --out a picture of the directions is drawn.

    Args:
        data: File or folder of any format that brdffit reads.
    """
    from functools import partial

    from brdffit.cli.inputs import read_data
    from brdffit.files import require_writable
    from brdffit.readers import READERS, format_of, title
    from brdffit.survey import summary

    with console.progress(3 if out else 2) as step:
        step(f"reading {data.name}")
        kind = format_of(data)
        reader = READERS[kind]
        measurement = read_data(data, channels, illuminant)
        if out:
            require_writable(out)
        step("looking at directions")
        changed = channels or illuminant
        anywhere = None if changed else getattr(reader, "evaluate", None)
        folded = getattr(reader, "RECIPROCAL", False)
        facts = summary(measurement, anywhere and partial(anywhere, data), folded)
        written = []
        if out:
            from brdffit.plots import coverage_figure, save

            step("drawing")
            out.mkdir(parents=True, exist_ok=True)
            written = save(coverage_figure(measurement), out, "coverage")
    if as_json:
        content = {"format": kind} | facts.to_dict()
        console.print_json(content | {"files": [str(path) for path in written]})
    else:
        print_summary(title(reader), facts, folded)
        console.print_written(written)


def print_summary(format: str, facts: "Summary", folded: bool) -> None:
    """The summary as sentences and a table of channels.

    Args:
        format: What the format is called.
        facts: What to print.
        folded: Whether the format keeps one value for both orders of a pair.
    """
    from brdffit.cli.tables import new_table

    say = console.print_line
    say(f"{facts.name}: {format}.")
    what = f"{facts.images} images, " if facts.images else ""
    lights = f", each under {facts.lights} lights" if facts.lights > 1 else ""
    kind = "pixels" if facts.images else "pairs of directions"
    say(f"{what}{facts.samples} {kind}{lights}.")
    say(
        "Polar angles of the light {:.4g} to {:.4g} degrees, of the viewer {:.4g} to "
        "{:.4g} degrees; {} of the light.".format(
            *facts.theta_i,
            *facts.theta_o,
            f"{facts.azimuths} azimuth{'s' if facts.azimuths > 1 else ''}",
        )
    )
    invalid = ", ".join(f"{count} {why}" for why, count in facts.invalid.items())
    say(f"{facts.usable} usable values; {invalid or 'none is invalid'}.")
    known = [
        *(["the error of every value"] if facts.sigma else []),
        *(["the solid angle of every sample"] if facts.solid_angle else []),
    ]
    if known:
        say(f"Known is {' and '.join(known)}.")
    found = facts.reciprocity
    if folded:
        say("Reciprocity: the format holds one value for both orders of a pair.")
    elif found is None:
        say("Reciprocity cannot be told: too few pairs of exchanged directions.")
    else:
        near = "" if found.exact else ", within a degree"
        near += ", if the surface is isotropic" if found.isotropic else ""
        say(
            f"Reciprocity: {found.pairs} values differ from those of exchanged "
            f"directions{near}, by {found.median:.2%} in the median, nine tenths of "
            f"them by less than {found.ninetieth:.2%}."
        )
    say()
    table = new_table("channel", "lowest", "highest", "")
    names, count = facts.channels, len(facts.channels)
    for place in range(count) if count <= FEW else (0, count // 2, count - 1):
        table.add_row(
            names[place],
            f"{facts.lowest[place]:.4g}",
            f"{facts.highest[place]:.4g}",
            facts.quantity,
        )
    console.output().print(table)
    if count > FEW:
        say(f"{count} channels in all, from {names[0]} to {names[-1]}.")
