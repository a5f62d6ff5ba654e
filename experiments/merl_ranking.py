"""Which models fit twenty stand-ins for MERL materials best, and how long does it take?

Each stand-in (see `merl_standins`) is written as a MERL file and read back, which gives
every value back to the last bit. Seven models are fitted under two residuals to a share
of its cells that stands for all, with both directions up to 80 degrees from the normal.
The published order is that of Ngan, Durand and Matusik 2005, who fitted MERL's
materials so under the cosine-weighted residual: Cook-Torrance before Ward-Duer before
Blinn-Phong.

Half vectors of a MERL file have azimuth 0, so the two slopes of `ward_duer` do not tell
a grain: one of them is the width of the lobe, the other only scales it. A second
`ggx_lobe` cannot vanish, because towards grazing it reflects even with f0 = 0; so
`ggx+ggx_lobe` may be a little worse than `ggx`. Errors weigh cells as their solid
angle, as the fits do.

It needs the folder `merl_standins` of the data folder that `BRDFFIT_DATA` names.
"""

import dataclasses
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from matplotlib.ticker import StrMethodFormatter

import brdffit
from brdffit.plots.style import COLOURS, entitle, new_figure
from brdffit.readers import merl
from brdffit.subset import subset
from brdffit.writers import merl as writer
from experiments import captions
from experiments.merl_standins import WEIGHTS, names, stand_in
from experiments.record import RESULTS, Record, styled

SAMPLES = 20_000
STEEPEST = 80  # degrees, beyond which measurements were not trusted
COUNT = 20
MODELS = (
    *("lambert", "phong", "blinn_phong", "ward_duer", "cook_torrance", "ggx"),
    "ggx+ggx_lobe",
)
RESIDUALS = ("cosine_weighted", "log")
STARTS = 8


def chosen(count):
    """Names of materials, evenly spread over the list of all."""
    known = names()
    return [known[int(i)] for i in np.linspace(0, len(known) - 1, count).round()]


def written_and_read(name, folder):
    """A stand-in as read from its file, the time that took, and whether it is whole."""
    made, path = stand_in(name), folder / f"{name}.binary"
    writer.save(made, path)
    started = time.perf_counter()
    read = merl.load(path)
    seconds = time.perf_counter() - started
    path.unlink()
    same = np.array_equal(read.mask, made.mask)
    same &= np.array_equal(read.f_r[read.mask], made.f_r[made.mask])
    return read, seconds, same


def up_to(data, degrees):
    """The data without directions nearer to the horizon."""
    lowest = np.cos(np.radians(degrees))
    near = (data.wi[:, 2] > lowest) & (data.wo[:, 2] > lowest)
    return dataclasses.replace(data, mask=data.mask & near[:, None])


def rows_of(name, folder, models, samples):
    """A row for each residual and model."""
    data, seconds, same = written_and_read(name, folder)
    share = subset(up_to(data, STEEPEST), samples)
    for residual in RESIDUALS:
        fits = {
            m: brdffit.fit(m, share, residual=residual, starts=STARTS) for m in models
        }
        best = min(fits.values(), key=lambda fit: fit.rms[residual])
        for model, fit in fits.items():
            yield {
                "material": name,
                "residual": residual,
                "model": model,
                "rms": fit.rms[residual],
                "over_best": fit.rms[residual] / best.rms[residual],
                "converged": fit.converged,
                "fit_seconds": round(fit.seconds, 2),
                "read_seconds": round(seconds, 2),
                "identical": same,
            }


def ranking(rows):
    """A row for each residual and model: how its error compares over all materials."""
    for residual in RESIDUALS:
        mine = [row for row in rows if row["residual"] == residual]
        models = list(dict.fromkeys(row["model"] for row in mine))
        found = [
            {
                "residual": residual,
                "model": model,
                "median_over_best": float(
                    np.median([r["over_best"] for r in mine if r["model"] == model])
                ),
                "best_on": sum(
                    r["over_best"] == 1 for r in mine if r["model"] == model
                ),
                "median_rms": float(
                    np.median([r["rms"] for r in mine if r["model"] == model])
                ),
                "seconds_a_fit": float(
                    np.median([r["fit_seconds"] for r in mine if r["model"] == model])
                ),
            }
            for model in models
        ]
        yield from sorted(found, key=lambda row: row["median_over_best"])


def orders(rows):
    """On how many materials one model beats another, for the published pairs."""
    pairs = (("cook_torrance", "ward_duer"), ("ward_duer", "blinn_phong"))
    rms = {(r["material"], r["residual"], r["model"]): r["rms"] for r in rows}
    materials = list(dict.fromkeys(row["material"] for row in rows))
    for residual in RESIDUALS:
        for better, worse in pairs:
            ratios = np.array(
                [rms[m, residual, worse] / rms[m, residual, better] for m in materials]
            )
            yield {
                "residual": residual,
                "better": better,
                "worse": worse,
                "better_on": int(np.sum(ratios > 1)),
                "of": len(materials),
                "median_ratio": float(np.median(ratios)),
            }


@styled
def chart(rows, title):
    """Error of every model on every material, over that of the best."""
    figure = new_figure(9.0, 4.2)
    panels = figure.subplots(1, len(RESIDUALS), squeeze=False)[0]
    for axes, residual in zip(panels, RESIDUALS, strict=True):
        mine = [row for row in rows if row["residual"] == residual]
        order = [r["model"] for r in ranking(rows) if r["residual"] == residual]
        for place, model in enumerate(order):
            ratios = [r["over_best"] for r in mine if r["model"] == model]
            axes.plot(
                ratios, [place] * len(ratios), "o", color=COLOURS[0], alpha=0.45, ms=4
            )
            axes.plot(np.median(ratios), place, "|", color="black", ms=16, mew=2)
        axes.set_yticks(range(len(order)), order)
        axes.set(
            xscale="log", title=f"residual {residual}", ylim=(len(order) - 0.5, -0.5)
        )
        axes.set_xlabel("error over that of the best model of the seven, log scale")
        axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.xaxis.set_minor_formatter(StrMethodFormatter("{x:g}"))
    count = len({row["material"] for row in rows})
    entitle(figure, title)
    figure.supxlabel(
        f"{count} stand-ins for MERL materials (points) and their median (bar)", size=8
    )
    return figure


def main(folder=RESULTS / "merl_ranking", count=COUNT, models=MODELS, samples=SAMPLES):
    """Write the tables and the figure."""
    if not WEIGHTS.is_file():
        sys.exit(f"File `{WEIGHTS}` must exist: set BRDFFIT_DATA.")
    brdffit.enable_compilation_cache()
    record, rows = Record(folder, seed=0), []
    with tempfile.TemporaryDirectory() as scratch:
        for name in chosen(count):
            rows += rows_of(name, Path(scratch), models, samples)
            print(name, f"{time.perf_counter() - record.started:.0f} s", flush=True)
    record.table(list(ranking(rows)))
    record.table(rows, "fits")
    if {"cook_torrance", "ward_duer", "blinn_phong"} <= set(models):
        record.table(list(orders(rows)), "published_order")
    record.figure(chart(rows, captions.merl_ranking(record.folder)))
    record.close(samples=samples, starts=STARTS, steepest_degrees=STEEPEST)


if __name__ == "__main__":
    main()
