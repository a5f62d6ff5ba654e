"""``brdffit fit``: one model, one measurement."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import Channels, Json, Out, assignments

STEPS = 2  # reading and fitting
PICTURES = 4  # steps of drawing


def fit(
    data: Path,
    /,
    *,
    model: str,
    residual: str | None = None,
    starts: int = 16,
    fix: Annotated[tuple[str, ...], Parameter(consume_multiple=True)] = (),
    channels: Channels = None,
    out: Out = None,
    as_json: Json = False,
) -> int:
    """Fit a model to a measurement and say how sure its parameters are.

    Exit status: 0 done, 1 did not converge, 2 bad input.

    Args:
        data: Table, FRED or Zemax text, EXR of a sphere, or folder of photographs.
        model: Name of a model, or several with + between them; see brdffit models.
        residual: What is compared. [log for reflectance, cosine_weighted for images]
        starts: Number of starts, spread over typical ranges. [16]
        fix: Parameters to hold, as in alpha=0.2.
    """
    from brdffit.catalogue import from_name
    from brdffit.cli.inputs import read_data
    from brdffit.cli.printing import print_fit
    from brdffit.files import require_writable
    from brdffit.fit import RESIDUALS
    from brdffit.names import look_up

    fixed = assignments(fix, "--fix")
    from_name(model)
    if residual:
        look_up(RESIDUALS, residual, "Residual")
    brdffit.enable_compilation_cache()
    with console.progress(STEPS + (PICTURES if out else 0)) as step:
        step(f"reading {data.name}")
        measurement = read_data(data, channels)
        if out:
            require_writable(out)
        step(f"fitting {model}")
        result = brdffit.fit(
            model, measurement, residual=residual, starts=starts, fixed=fixed
        )
        written = []
        if out:
            from brdffit.cli.pictures import write_pictures

            out.mkdir(parents=True, exist_ok=True)
            result.save(out / "result.json")
            written = [out / "result.json"]
            written += write_pictures(measurement, result, out, step)
    if as_json:
        console.print_json(result.to_dict() | {"files": [str(p) for p in written]})
    else:
        print_fit(result, written)
    return 0 if result.converged else 1
