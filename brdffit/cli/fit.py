"""``brdffit fit``: one model, one measurement."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import (
    Channels,
    Illuminant,
    Json,
    Out,
    Report,
    Share,
    assignments,
)

Words = Annotated[tuple[str, ...], Parameter(consume_multiple=True)]
STEPS = 2  # reading and fitting
PICTURES = 4  # steps of drawing


def fit(
    data: Path,
    /,
    *,
    model: str,
    residual: str | None = None,
    starts: int = 16,
    fix: Words = (),
    tied: Words = (),
    per_channel: Words = (),
    prior: Words = (),
    loss: str | None = None,
    profile: str | None = None,
    bootstrap: int | None = None,
    channels: Channels = None,
    illuminant: Illuminant = None,
    samples: Share = None,
    out: Out = None,
    report: Report = False,
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
        tied: Parameters to give one value in all channels.
        per_channel: Shared parameters to give a value in each channel.
        prior: Mean and standard deviation of a parameter, as in alpha=0.2,0.05.
        loss: huber or cauchy, which keep outliers from leading the fit.
        profile: Parameter whose 95 % interval to find by refitting.
        bootstrap: Number of resamples from which to find all 95 % intervals.
    """
    from brdffit.catalogue import from_name
    from brdffit.cli.inputs import read_data
    from brdffit.files import require_writable
    from brdffit.fit import RESIDUALS
    from brdffit.names import look_up

    options = {
        "residual": residual,
        "loss": loss,
        "starts": starts,
        "fixed": assignments(fix, "--fix"),
        "tied": tied,
        "per_channel": per_channel,
        "priors": assignments(prior, "--prior"),
    }
    from_name(model)
    if residual:
        look_up(RESIDUALS, residual, "Residual")
    brdffit.enable_compilation_cache()
    more = (profile is not None) + (bootstrap is not None)
    with console.progress(STEPS + more + (PICTURES if out else 0) + report) as step:
        step(f"reading {data.name}")
        measurement = read_data(data, channels, illuminant, samples)
        if out or report:
            require_writable(out or Path())
        step(f"fitting {model}")
        result = brdffit.fit(model, measurement, **options)
        found = {}
        if profile is not None:
            step(f"profile of {profile}")
            found["profile"] = brdffit.profile(model, measurement, profile, **options)
        if bootstrap is not None:
            step(f"{bootstrap} resamples")
            found["bootstrap"] = brdffit.bootstrap(
                model, measurement, resamples=bootstrap, **options
            )
        written = []
        if out:
            from brdffit.cli.pictures import write_pictures

            out.mkdir(parents=True, exist_ok=True)
            result.save(out / "result.json")
            written = [out / "result.json"]
            written += write_pictures(measurement, result, out, step)
            if profile is not None:
                from brdffit.plots import profile_figure, save

                written += save(profile_figure(found["profile"]), out, "profile")
        if report:
            from brdffit.cli.pictures import write_report

            step("writing the report")
            changed = bool(channels or illuminant)
            written.append(write_report(result, measurement, data, out, changed))
    if as_json:
        intervals = {name: each.to_dict() for name, each in found.items()}
        files = {"files": [str(path) for path in written]}
        console.print_json(result.to_dict() | intervals | files)
    else:
        from brdffit.cli.printing import print_fit, print_intervals

        print_fit(result, written)
        print_intervals(**found)
    return 0 if result.converged else 1
