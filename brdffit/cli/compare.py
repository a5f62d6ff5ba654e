"""``brdffit compare``: many models, one measurement, ranked."""

from pathlib import Path

import brdffit
from brdffit.cli import console
from brdffit.cli.options import (
    Channels,
    Illuminant,
    Json,
    Out,
    Report,
    Share,
    chosen_models,
)

MODELS = "lambert,oren_nayar,phong,blinn_phong,cook_torrance,beckmann,ggx"
PICTURES = 5  # steps of drawing


def compare(
    data: Path,
    /,
    *,
    models: str = MODELS,
    residual: str | None = None,
    starts: int = 16,
    seed: int = 0,
    second_lobe: bool = False,
    channels: Channels = None,
    illuminant: Illuminant = None,
    samples: Share = None,
    out: Out = None,
    report: Report = False,
    as_json: Json = False,
) -> int:
    """Fit many models to a measurement and rank them by their error on unseen data.

    Exit status: 0 done, 1 a model did not converge, 2 bad input.

    Args:
        data: Table, FRED or Zemax text, EXR of a sphere, or folder of photographs.
        models: Names with commas between them, or all; a + makes a sum. [seven]
        residual: What is compared. [log for reflectance, cosine_weighted for images]
        starts: Number of starts, spread over typical ranges. [16]
        seed: Seed of the split into directions that are fitted and held out. [0]
        second_lobe: Also try the winner with a second lobe, if that earns its keep.
    """
    from brdffit.catalogue import from_name
    from brdffit.cli.inputs import read_data
    from brdffit.cli.printing import print_comparison
    from brdffit.cli.spreadsheet import write_tables
    from brdffit.files import require_writable
    from brdffit.fit import RESIDUALS
    from brdffit.names import look_up
    from brdffit.scene.values import whole

    names = chosen_models(models)
    for name in names:
        from_name(name)
    if not names:
        raise ValueError("Option --models must name at least one model.")
    whole("--seed", seed, least=0)
    if residual:
        look_up(RESIDUALS, residual, "Residual")
    brdffit.enable_compilation_cache()
    with console.progress(
        1 + len(names) + second_lobe + (PICTURES if out else 0) + report
    ) as step:
        step(f"reading {data.name}")
        measurement = read_data(data, channels, illuminant, samples)
        if out or report:
            require_writable(out or Path())
        comparison = brdffit.compare(
            measurement,
            names,
            residual=residual,
            starts=starts,
            seed=seed,
            second_lobe=second_lobe,
            on_model=lambda name: step(f"fitting {name}"),
        )
        written = []
        if out:
            from brdffit.cli.pictures import write_pictures

            out.mkdir(parents=True, exist_ok=True)
            comparison.save(out / "comparison.json")
            written = [out / "comparison.json", *write_tables(comparison, out)]
            for name, result in comparison.results.items():
                written.append(out / f"{name}.json")
                result.save(written[-1])
            written += write_pictures(measurement, comparison, out, step)
        if report:
            from brdffit.cli.pictures import write_report

            step("writing the report")
            changed = bool(channels or illuminant)
            written.append(write_report(comparison, measurement, data, out, changed))
    if as_json:
        console.print_json(comparison.to_dict() | {"files": [str(p) for p in written]})
    else:
        print_comparison(comparison, written)
    return 0 if all(e.result.converged for e in comparison.entries) else 1
