"""``brdffit plan``: which effects a scene calls for, and why."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import (
    Json,
    Settings,
    Tolerance,
    With,
    Within,
    Without,
    assignments,
)


def plan(
    scene: Annotated[Path, Parameter("SCENE")],
    /,
    *,
    model: str | None = None,
    settings: Settings = (),
    tolerance: Tolerance = None,
    with_: With = (),
    without: Without = (),
    within: Within = "given",
    as_json: Json = False,
) -> None:
    """Say for each effect whether a scene calls for it, and what it costs.

    Args:
        scene: Scene, a TOML file.
        model: Name of the model, or file of a saved result, for shapes without a
            material; without it the plan holds for any.
    """
    from brdffit.cli.inputs import saved_or_named
    from brdffit.effects.plan import TOLERANCE

    brdffit.enable_compilation_cache()
    view = brdffit.load_scene(scene)
    given = assignments(settings, "--set")
    if given and model is None:
        raise ValueError("Option --set needs the model whose parameters it sets.")
    brdf = saved_or_named(model, given, view.channels) if model else None
    with console.progress(1) as step:
        step("planning")
        made = brdffit.plan(
            view,
            brdf,
            tolerance=TOLERANCE if tolerance is None else tolerance,
            with_=with_,
            without=without,
            within=within,
        )
    if as_json:
        console.print_json(description(made))
        return
    from brdffit.cli.tables import new_table

    table = new_table("effect", "", "error", "cost", "why")
    for name, decision in made.decisions.items():
        state = "on" if decision.on else "off"
        table.add_row(
            name,
            f"{state} *" if decision.overridden else state,
            f"{decision.error:.2g}" if decision.error else "",
            f"{decision.cost:,.0f}" if decision.cost else "",
            decision.why,
        )
    console.output().print(table)
    console.print_line()
    console.print_line(
        f"Errors are root mean squares of what leaving an effect out would change, "
        f"relative to the image; those above {made.tolerance:g} are simulated, but a "
        "model is only changed by --with and --without. Costs are arithmetic "
        "operations per pixel."
    )
    for sentence in made.overridden:
        console.print_line(sentence)


def description(made: "brdffit.Plan") -> dict:
    """A plan in names and numbers."""
    return {
        "tolerance": made.tolerance,
        "directions": made.directions,
        "effects": {
            name: {
                "on": decision.on,
                "needed": decision.needed,
                "overridden": decision.overridden,
                "error": decision.error,
                "cost": decision.cost,
                "why": decision.why,
            }
            for name, decision in made.decisions.items()
        },
    }
