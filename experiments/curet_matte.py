"""How much does a rough model gain over Lambert's on the ten matte samples of CUReT?

Plain f_r is compared, as its error was published. Every sample has 205 pairs of
directions and one channel. Ratios are errors of Lambert over those of the model.

It needs the folder `curet` of the data folder that `BRDFFIT_DATA` names.
"""

import dataclasses
import sys

import numpy as np

import brdffit
from brdffit.plots.style import COLOURS, entitle, new_figure
from brdffit.readers import curet
from experiments import captions
from experiments.merl_standins import DATA
from experiments.record import RESULTS, Record, styled

MATTE = (8, 10, 11, 14, 30, 35, 45, 47, 49, 50)
MODELS = ("lambert", "oren_nayar", "oren_nayar_full", "eon")
MARKS = ("o", "s", "^")


def rows_of(sample, models):
    """Errors of every model on one sample."""
    data = curet.load(DATA / "curet", sample)
    data = dataclasses.replace(data, channels=("mean of RGB",))
    fits = {m: brdffit.fit(m, data, residual="plain", starts=8) for m in models}
    plain = fits["lambert"].rms["plain"]
    row = {"sample": sample, "lambert_rms": plain}
    for model, fit in list(fits.items())[1:]:
        row[f"{model}_gain"] = plain / fit.rms["plain"]
        rough = fit.parameters.get("sigma", fit.parameters.get("roughness"))
        row[f"{model}_roughness"] = float(rough)
    return row


def gains(rows, models):
    """Least, median and largest gain of every model."""
    for model in models[1:]:
        found = np.array([row[f"{model}_gain"] for row in rows])
        over = found / np.array([row["oren_nayar_gain"] for row in rows])
        yield {
            "model": model,
            "least_gain": float(found.min()),
            "median_gain": float(np.median(found)),
            "largest_gain": float(found.max()),
            "median_gain_over_oren_nayar": float(np.median(over)),
        }


@styled
def chart(rows, models, title):
    """Gain over Lambert, sample by sample."""
    figure = new_figure(7.0, 3.4)
    axes = figure.subplots()
    names = [str(row["sample"]) for row in rows]
    for place, (model, mark) in enumerate(zip(models[1:], MARKS, strict=False)):
        shifted = np.arange(len(rows)) + 0.15 * (place - 1)
        values = [row[f"{model}_gain"] for row in rows]
        axes.plot(shifted, values, mark, color=COLOURS[place], label=model, ms=6)
    axes.axhline(1, color="black", lw=0.8)
    axes.set_xticks(range(len(names)), names)
    axes.set_ylim(0.8, None)
    axes.set(xlabel="matte sample of CUReT", ylabel="error of lambert / error of model")
    entitle(figure, title)
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def main(folder=RESULTS / "curet_matte", samples=MATTE, models=MODELS):
    """Write the tables and the figure."""
    if not (DATA / "curet").is_dir():
        sys.exit(f"Folder `{DATA / 'curet'}` must exist: set BRDFFIT_DATA.")
    record = Record(folder)
    rows = [rows_of(sample, models) for sample in samples]
    record.table(rows)
    record.table(list(gains(rows, models)), "gains")
    record.figure(chart(rows, models, captions.curet_matte(record.folder)))
    record.close()


if __name__ == "__main__":
    main()
