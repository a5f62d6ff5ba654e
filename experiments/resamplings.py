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
from brdffit.plots.style import COLOURS, MUTED, entitle, new_figure
from experiments.record import RESULTS, Record, styled

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


@styled
def chart(rows, title):
    """Parameters from one choice of samples against those from the other."""
    rows = [row for row in rows if row["fred"] > 0 and row["zemax"] > 0]
    figure = new_figure(5.2, 4.6)
    axes = figure.subplots()
    coatings = list(dict.fromkeys(row["coating"] for row in rows))
    for coating, colour, mark in zip(coatings, COLOURS, "o^", strict=False):
        own = [row for row in rows if row["coating"] == coating]
        axes.plot(
            [row["fred"] for row in own],
            [row["zemax"] for row in own],
            mark,
            color=colour,
            ms=5,
            alpha=0.8,
            label=coating,
        )
    ends = [
        f(row[end] for row in rows for end in ("fred", "zemax")) for f in (min, max)
    ]
    axes.plot(ends, ends, color=MUTED, lw=0.8, label="equal")
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("parameter fitted to the FRED file, log scale")
    axes.set_ylabel("to the Zemax file, log scale")
    figure.legend(loc="outside lower center", ncols=3)
    entitle(figure, title)
    return figure


def main(folder=RESULTS / "resamplings"):
    """Write the table and the figure."""
    if not (DATA / "ualoft").is_dir():
        sys.exit(f"Folder `{DATA / 'ualoft'}` must exist: set BRDFFIT_DATA.")
    record = Record(folder)
    rows = [r for c in COATINGS for m in MODELS for r in rows_of(c, m)]
    record.table(rows)
    apart = [row["difference_in_errors"] for row in rows]
    apart = float(np.median([x for x in apart if np.isfinite(x)]))
    finding = (
        f"Parameters differ between the two by {apart:.1f} of their standard errors in "
        "the median"
    )
    if apart > 1:
        finding += ": the choice of samples decides more than their noise"
    record.figure(chart(rows, finding))
    record.close(finding=finding + ".")


if __name__ == "__main__":
    main()
