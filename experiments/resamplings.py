"""How far do fits differ between two resamplings of one goniometer run?

Two black coatings were measured once each and published twice: as FRED text on a grid
of angles, and as Zemax text on a grid about the specular ray. Every model is fitted to
both under the log residual. The difference of a parameter, in its own standard errors,
says how much more the choice of samples decides than their noise.

It needs the folder `ualoft` of the data folder that `BRDFFIT_DATA` names.
"""

import os
import sys
from pathlib import Path

import numpy as np

import brdffit
from experiments.record import RESULTS, Record

DATA = Path(os.environ.get("BRDFFIT_DATA", RESULTS.parents[1] / "shared" / "data"))
COATINGS = ("AnoBlackEC1onAlum", "AnoBlackNiTEonINVAR")
MODELS = ("lambert", "oren_nayar", "phong", "cook_torrance", "ggx")


def rows_of(coating, model):
    """A row for each parameter of a model on one coating."""
    fred, zemax = (
        brdffit.fit(model, brdffit.load(DATA / "ualoft" / f"{coating}{suffix}"))
        for suffix in (".txt", ".bsdf")
    )
    for name in fred.parameters:
        pair = [float(np.ravel(fit.parameters[name])[0]) for fit in (fred, zemax)]
        errors = [
            float(np.ravel(fit.standard_errors[name])[0]) for fit in (fred, zemax)
        ]
        yield {
            "coating": coating,
            "model": model,
            "parameter": name,
            "fred": pair[0],
            "zemax": pair[1],
            "ratio": pair[1] / pair[0] if pair[0] else float("nan"),
            "difference_in_errors": abs(pair[1] - pair[0]) / float(np.hypot(*errors)),
            "log_rms_fred": fred.rms["log"],
            "log_rms_zemax": zemax.rms["log"],
        }


def main(folder=RESULTS / "resamplings"):
    """Write the table."""
    if not (DATA / "ualoft").is_dir():
        sys.exit(f"Folder `{DATA / 'ualoft'}` must exist: set BRDFFIT_DATA.")
    record = Record(folder)
    rows = [r for c in COATINGS for m in MODELS for r in rows_of(c, m)]
    record.table(rows)
    apart = [row["difference_in_errors"] for row in rows]
    apart = float(np.median([x for x in apart if np.isfinite(x)]))
    record.close(
        finding=f"Parameters differ between the two by {apart:.1f} of their standard "
        "errors in the median: the choice of samples decides more than their noise."
        if apart > 1
        else f"Parameters differ between the two by {apart:.1f} of their standard "
        "errors in the median."
    )


if __name__ == "__main__":
    main()
