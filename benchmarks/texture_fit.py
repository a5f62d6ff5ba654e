"""How many texels a second can be fitted, each on its own?

65,536 texels with 24 observations in three channels under directions of their own, with
noise of 1 %: `fit_texels`, TinySolver of Ceres with derivatives by hand and one start,
and a loop over `scipy.optimize.least_squares` for a few hundred texels, whose time is
extrapolated. Nothing in brdffit is written for any of the models. Each number of cores
has a process of its own; a minimum is right when its cost is within a thousandth of the
least that is known from any contestant or from a start at the truth.
"""

import json
import subprocess
import sys
from pathlib import Path

from benchmarks.record import RESULTS, facts
from benchmarks.textures import OBSERVATIONS
from brdffit.plots.style import COLOURS, MUTED, entitle, new_figure
from experiments.record import Record, styled
from experiments.tradeoff import rounded

MODELS = ("ggx", "cook_torrance", "ward_duer")
TEXELS, FEW, TURNS = 65_536, 200, 5


def one(model: str, texels: int, few: int, threads: int, turns: int) -> list[dict]:
    """The contestants on one number of cores, in a process of their own."""
    task = {
        "model": model,
        "texels": texels,
        "few": few,
        "threads": threads,
        "turns": turns,
    }
    found = subprocess.run(
        [sys.executable, "-m", "benchmarks.texture_fit_of_one", json.dumps(task)],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        cwd=Path(__file__).parents[1],
    )
    *said, rows = found.stdout.splitlines()
    print(*said, sep="\n", end="\n" if said else "")
    return json.loads(rows)


def finding(rows):
    """How many texels of each model are fitted in a second on all cores."""
    most = max(row["threads"] for row in rows)
    own = {
        row["model"]: row["texels_per_s"]
        for row in rows
        if row["contestant"] == "brdffit" and row["threads"] == most
    }
    speeds = ", ".join(f"{model} {rounded(speed)}" for model, speed in own.items())
    return f"Texels a second on {most} cores: {speeds}"


@styled
def chart(rows):
    """Texels per second of every contestant, one panel per model."""
    models = list(dict.fromkeys(row["model"] for row in rows))
    figure = new_figure(3.4 * len(models) + 1.6, 2.6)
    panels = figure.subplots(1, len(models), squeeze=False, sharey=True)[0]
    for axes, model in zip(panels, models, strict=True):
        own = [row for row in rows if row["model"] == model]
        own.sort(key=lambda row: (-row["threads"], -row["texels_per_s"]))
        names = [
            f"{row['contestant']}, {row['threads']} thread"
            + ("s" if row["threads"] > 1 else "")
            for row in own
        ]
        for place, row in enumerate(own):
            colour = COLOURS[0] if row["contestant"] == "brdffit" else MUTED
            axes.barh(place, row["texels_per_s"], color=colour, height=0.6)
            axes.annotate(
                f"{row['texels_per_s']:,.0f}, "
                f"{float(row['wrong'].rstrip('%')):.2g} % wrong",
                (row["texels_per_s"], place),
                xytext=(3, 0),
                textcoords="offset points",
                va="center",
                size=7,
            )
        axes.set_yticks(range(len(own)), names)
        axes.set(xscale="log", xlabel="texels per second, log scale", title=model)
        axes.set(ylim=(len(own) - 0.5, -0.5), xlim=(10, 3e7))
    entitle(figure, finding(rows))
    return figure


def main(
    folder=RESULTS / "texture_fit", models=MODELS, texels=TEXELS, few=FEW, turns=TURNS
):
    """Time all models on one core and on two."""
    record = Record(folder, 1)
    rows = []
    for model in models:
        for threads in (1, 2):
            rows += one(model, texels, few, threads, turns)
        print(model, "done", flush=True)
    record.table(rows)
    record.figure(chart(rows))
    record.close(finding=finding(rows) + ".", observations=OBSERVATIONS, **facts(turns))
    return rows


if __name__ == "__main__":
    main()
