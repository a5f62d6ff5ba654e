"""``brdffit render``: an image of a fitted or named material."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import (
    Json,
    Lights,
    Resolution,
    SceneFile,
    Settings,
    Tolerance,
    With,
    Without,
    assignments,
)


def render(
    source: Annotated[str, Parameter("RESULT|NAME")],
    /,
    *,
    settings: Settings = (),
    scene: SceneFile = None,
    lights: Lights = None,
    resolution: Resolution = None,
    tolerance: Tolerance = None,
    with_: With = (),
    without: Without = (),
    out: Annotated[Path, Parameter("--out")],
    as_json: Json = False,
) -> None:
    """Render a material as a linear image, with its scene and a preview beside it.

    Args:
        source: File of a saved result, or name of a model.
        out: Image to write, .exr; .toml and .png come beside it.
    """
    from brdffit.cli.inputs import saved_or_named, scene_or_sphere
    from brdffit.effects.plan import TOLERANCE
    from brdffit.files import require_writable
    from brdffit.render import description
    from brdffit.writers import sphere

    if out.suffix.lower() != ".exr":
        raise ValueError(f"Image `{out}` must end in .exr to keep its values.")
    require_writable(out.parent)
    brdffit.enable_compilation_cache()
    brdf = saved_or_named(source, assignments(settings, "--set"))
    view = scene_or_sphere(scene, lights, resolution)
    material = description(brdf)
    with console.progress(2) as step:
        step("planning")
        plan = brdffit.plan(
            view,
            brdf,
            tolerance=TOLERANCE if tolerance is None else tolerance,
            with_=with_,
            without=without,
        )
        step("rendering")
        image = brdffit.render(brdf, view, plan)
    out.parent.mkdir(parents=True, exist_ok=True)
    sphere.save_image(image, view, out, provenance=material)
    written = [out, *map(out.with_suffix, (".toml", ".png"))]
    if as_json:
        files = [str(path) for path in written]
        effects = [name for name in plan.decisions if plan.on(name)]
        facts = {"effects": effects, "overridden": plan.overridden}
        console.print_json({"material": material} | facts | {"files": files})
    else:
        rows, columns = view.camera.shape
        console.print_line(
            f"Rendered {material['model']} at {rows} x {columns} pixels."
        )
        for sentence in plan.overridden:
            console.print_line(sentence)
        console.print_written(written)
