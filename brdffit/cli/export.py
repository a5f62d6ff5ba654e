"""``brdffit export``: a fitted material for a renderer, with its error."""

from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import Json, Settings, assignments


def export(
    source: Annotated[str, Parameter("RESULT|NAME")],
    /,
    *,
    to: str,
    settings: Settings = (),
    out: Annotated[Path, Parameter("--out")],
    as_json: Json = False,
) -> None:
    """Write a material for a renderer and say how far it is from the fit.

    Where the renderer has no such model, the nearest material that it has is taken.

    Args:
        source: File of a saved result, or name of a model.
        to: Target: mitsuba, materialx, gltf, glsl or merl.
        out: File to write: .xml, .mtlx, .gltf, .glsl or .binary.
    """
    from brdffit.cli.inputs import saved_channels, saved_or_named
    from brdffit.exports import EXPORTS
    from brdffit.names import look_up

    look_up(EXPORTS, to, "Target")
    brdffit.enable_compilation_cache()
    brdf = saved_or_named(source, assignments(settings, "--set"))
    with console.progress(1) as step:
        step(f"translating to {to}")
        out.parent.mkdir(parents=True, exist_ok=True)
        exported = brdffit.export(brdf, to, out, saved_channels(source))
    if as_json:
        console.print_json(exported.to_dict())
        return
    console.print_line(f"Exported to {to}; {words(exported.parameters)}.")
    for note in exported.notes:
        console.print_line(note)
    error = exported.deviation
    console.print_line(
        f"Relative error of f_r over {error.count} pairs of directions up to 80 "
        f"degrees, by {exported.evaluator}: {error}."
    )
    console.print_written([out])


def words(parameters: Any) -> str:
    """Parameters as a user reads them."""
    if isinstance(parameters, list):
        return ", ".join(words(value) for value in parameters)
    if isinstance(parameters, float):
        return f"{parameters:.4g}"
    if not isinstance(parameters, dict):
        return str(parameters)
    if parameters.get("type") == "rgb":
        return words(parameters["value"])
    parts = []
    for name, value in parameters.items():
        inner = isinstance(value, dict) and value.get("type") != "rgb"
        parts.append(f"{name} ({words(value)})" if inner else f"{name} {words(value)}")
    return "; ".join(parts)
