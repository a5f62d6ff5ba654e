"""Which of three classic models explains which material, under which residual?

Phong, Cook-Torrance and Oren-Nayar, fitted under four residuals to the same sets: three
simulated, each with one of the models as its truth and 1 % of noise, and five measured
materials (RGL). Every measured material can be evaluated at any pair of directions, so
that the sphere of a fit is compared with the sphere of the material itself, under two
lights: CIEDE2000 and Delta E ITP tell what a viewer would see. The models are ranked
under each residual by the error that it minimises, and by each colour difference.

Measured materials whose files are not in the folder that `BRDFFIT_DATA` names are left
out.
"""

import numpy as np

import brdffit
from brdffit.fit.appearance import colour_difference
from experiments.comparison_figures import (
    CLASSIC,
    RESIDUALS,
    best,
    lobes,
    matrix,
    spheres,
)
from experiments.comparison_sets import SEED, materials, modelled, sphere
from experiments.record import RESULTS, Record

SAMPLES, STARTS = 2000, 8
RESOLUTION = 96  # of spheres


def rows_of(name, material, resolution, starts):
    """Lines of one material, and what is drawn of it."""
    _, wanted = sphere(material.f_r, resolution)
    rows, fits = [], {}
    for residual in RESIDUALS:
        for model in CLASSIC:
            fit = brdffit.fit(model, material.data, residual=residual, starts=starts)
            _, shown = sphere(modelled(fit.brdf), resolution)
            seen = colour_difference(shown, wanted)
            fits[residual, model] = fit
            rows.append(
                {
                    "material": name,
                    "residual": residual,
                    "model": model,
                    "rms": fit.rms[residual],
                    "rms_log": fit.rms["log"],
                    "ciede2000": seen.ciede2000,
                    "delta_e_itp": seen.itp,
                    "converged": fit.converged,
                }
            )
    return rows, fits


def parameters_of(name, fits):
    """Parameters with their standard errors, a line for each number."""
    for (residual, model), fit in fits.items():
        for parameter, value in fit.parameters.items():
            error = np.ravel(fit.standard_errors[parameter])
            for place, number in enumerate(np.ravel(value)):
                channel = f"[{'RGB'[place]}]" if np.size(value) > 1 else ""
                yield {
                    "material": name,
                    "residual": residual,
                    "model": model,
                    "parameter": parameter + channel,
                    "value": float(number),
                    "standard_error": float(error[min(place, len(error) - 1)]),
                    "at_bound": parameter in fit.at_bound,
                    "undetermined": parameter in str(fit.undetermined),
                }


def verdicts(rows):
    """Who wins on each material: by each residual, and to a viewer."""
    for material in dict.fromkeys(row["material"] for row in rows):
        line = {"material": material}
        for residual in RESIDUALS:
            line[residual] = best(rows, "rms", material=material, residual=residual)[
                "model"
            ]
        for key in ("ciede2000", "delta_e_itp"):
            seen = best(rows, key, material=material)
            line |= {f"{key}_model": seen["model"], f"{key}_residual": seen["residual"]}
            line[key] = seen[key]
        yield line


def finding(lines):
    """How much the residual decides, and which one a viewer would pick."""
    fickle = sum(len({line[r] for r in RESIDUALS}) > 1 for line in lines)
    picked = [line["ciede2000_residual"] for line in lines]
    often = max(sorted(set(picked)), key=picked.count)
    agree = [
        sum(line[r] == line["ciede2000_model"] for line in lines) for r in RESIDUALS
    ]
    return (
        f"The residual changes the winner on {fickle} of {len(lines)} materials; the "
        f"sphere closest in CIEDE2000 comes most often from {often}, on "
        f"{picked.count(often)}, and the winner under "
        f"{RESIDUALS[int(np.argmax(agree))]} is a viewer's on {max(agree)}"
    )


def main(
    folder=RESULTS / "model_comparison",
    samples=SAMPLES,
    resolution=RESOLUTION,
    starts=STARTS,
    names=None,
):
    """Write tables and figures."""
    brdffit.enable_compilation_cache()
    record, rows, fitted, parameters = Record(folder, SEED), [], {}, []
    found = materials(samples)
    found = {name: found[name] for name in names or found}
    for name, material in found.items():
        own, fitted[name] = rows_of(name, material, resolution, starts)
        rows += own
        parameters += parameters_of(name, fitted[name])
        print(name, "done", flush=True)
    lines = list(verdicts(rows))
    record.table(rows)
    record.table(lines, "winners")
    record.table(parameters, "parameters")
    record.figure(matrix(rows, finding(lines)))
    record.figure(spheres(found, fitted, rows, resolution), "spheres")
    record.figure(lobes(found, fitted), "lobes")
    record.close(finding=finding(lines) + ".", samples=samples, starts=starts)


if __name__ == "__main__":
    main()
