"""``brdffit svbrdf``: one model, fitted to every texel of a surface."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import Cluster, Json, Resume, assignments

if TYPE_CHECKING:
    from brdffit.batch.svbrdf import Svbrdf

Words = Annotated[tuple[str, ...], Parameter(consume_multiple=True)]
TOLERATED = 0.01  # share of texels that may not converge


def svbrdf(
    stack: Path,
    /,
    *,
    model: str,
    out: Annotated[Path, Parameter("--out")],
    hold_out: str | None = None,
    residual: str | None = None,
    fix: Words = (),
    resume: Resume = False,
    cluster: Cluster = None,
    as_json: Json = False,
) -> int:
    """Fit a model to every texel of a photographed surface, and draw the maps.

    A folder of photographs holds scene.toml with one light for each, or is one as
    DiLiGenT has them. Written are EXR maps of every parameter, of its standard error
    and of how the fits went, a sheet of all maps, and the same numbers as zarr groups.

    Exit status: 0 done, 1 more than 1 % of the texels did not converge, 2 bad input,
    130 interrupted.

    Args:
        stack: Folder of photographs or zarr group.
        model: Name of a model, or several with + between them; see brdffit models.
        out: Folder of the run; new, or with --resume that of an earlier one.
        hold_out: Photograph not to fit but to predict, by its name or number.
        residual: What is compared. [cosine_weighted]
        fix: Parameters to hold in all texels, as in alpha=0.2.
    """
    from brdffit.batch.svbrdf import svbrdf as run

    brdffit.enable_compilation_cache()
    with console.tally_bar() as show:
        done = run(
            model,
            stack,
            out,
            hold_out=hold_out,
            residual=residual,
            fixed=assignments(fix, "--fix"),
            resume=resume,
            cluster=cluster,
            on_progress=show,
        )
    if as_json:
        files = [str(path) for path in [*done.files, *done.maps]]
        console.print_json(done.summary | {"files": files})
    else:
        print_svbrdf(done)
    return 1 if done.summary["converged"] < 1 - TOLERATED else 0


def print_svbrdf(done: "Svbrdf") -> None:
    """Medians of the parameters, how the fits ended, and the prediction."""
    from brdffit.cli.tables import new_table

    said = done.summary
    console.print_line(
        f"{said['model']} fitted to {said['texels']:,} texels of {said['name']}, each "
        f"seen in {said['observations']} photographs; medians:"
    )
    console.print_line()
    table = new_table("parameter", "value", "error")
    for name, found in said["parameters"].items():
        pairs = list(zip(found["median"], found["standard_error"], strict=True))
        for channel, (value, error) in zip(said["channels"], pairs, strict=False):
            label = name if len(pairs) == 1 else f"{name}[{channel}]"
            shown = "not determined" if error is None else f"{error:.2g}"
            table.add_row(label, f"{value:.4g}", shown)
    console.output().print(table)
    console.print_line()
    console.print_line(
        f"Of the texels {100 * said['converged']:.2f} % converged, and "
        f"{100 * said['at_bound']:.2f} % have a parameter at its bound. The median of "
        f"their root mean square residuals is {said['median_rms']:.3g}."
    )
    if "held_out" in said:
        other = said["held_out"]
        each = ", ".join(
            f"{channel} {100 * error:.2f} %"
            for channel, error in zip(
                said["channels"], other["relative_rms_of_channels"], strict=True
            )
        )
        console.print_line(
            f"{other['photograph']} was held out; the maps predict it with a relative "
            f"root mean square error of {100 * other['relative_rms']:.2f} % ({each})."
        )
    console.print_line(done.tally.sentence)
    console.print_written(done.maps)
    console.print_written(done.files)
