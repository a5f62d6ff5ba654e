"""What do many starts gain on hard cases, and what do they cost?

Sharp lobes on a coarse grid of angles leave few samples in the highlight and many off
it, and the cost has other minima there. Each noisy case is fitted from one start in the
middle of the typical ranges, from one start at the lobe that the data show, and from 4,
16 and 64 starts. `excess` is the cost above the best that any of them found, in units
of the cost of noise alone; `missed` is the share of cases that end there by more than
1 %.

    python -m experiments.many_starts
"""

import time

import jax.numpy as jnp
import numpy as np
from matplotlib.ticker import NullFormatter

import brdffit
from brdffit import Goniometer, Noise, simulate_measurement
from brdffit.catalogue import from_name
from brdffit.fit.start import typical_box
from brdffit.fit.transforms import Layout, to_natural, unpack
from brdffit.plots.style import COLOURS, entitle, new_figure
from experiments.record import RESULTS, Record, styled

CASES = 50
SEED = 21
NOISE = 0.01
SHARP = {"alpha": (0.002, 0.02), "alpha_x": (0.002, 0.02), "alpha_y": (0.01, 0.1)}
SHARP |= {"exponent": (1e3, 2e4)}
MODELS = ("ggx", "ggx_anisotropic", "ward_duer", "blinn_phong", "ggx+ggx_lobe")
GRID = Goniometer(
    theta_i=(10, 35, 60, 75), theta_o=np.arange(5, 86, 5), phi=(0, 60, 120, 160, 180)
)
COUNTS = ("middle", 1, 4, 16, 64)


def truth(name, random):
    """A model with sharp lobes, its other parameters within their typical ranges."""
    layout = Layout.of(from_name(name, 1))
    natural = []
    for label, known in zip(layout.labels, layout.known, strict=True):
        low, high = SHARP.get(label.rpartition(".")[2], known.typical)
        if known.logarithmic:
            natural.append(np.exp(random.uniform(np.log(low), np.log(high))))
        else:
            natural.append(random.uniform(low, high))
    return unpack(layout, from_name(name, 1), jnp.array(natural, jnp.float32))


def middle(name):
    """The model in the middle of its typical ranges."""
    layout = Layout.of(from_name(name, 1))
    low, high = typical_box(layout)
    places = tuple(range(len(layout.labels)))
    natural = to_natural(layout, jnp.float32(low + high) / 2, places)
    return unpack(layout, from_name(name, 1), natural)


def rows_of(name, cases):
    """A row for each number of starts."""
    random = np.random.default_rng(SEED)
    costs = {count: [] for count in COUNTS}
    seconds = {count: [] for count in COUNTS}
    for case in range(cases):
        noise = Noise(NOISE, seed=SEED + case)
        data = simulate_measurement(truth(name, random), GRID, noise)
        for count in COUNTS:
            model, starts = (middle(name), 1) if count == "middle" else (name, count)
            begin = time.perf_counter()
            result = brdffit.fit(model, data, residual="plain", starts=starts)
            seconds[count].append(time.perf_counter() - begin)
            costs[count].append(result.cost / (result.count / 2))
    best = np.min([costs[count] for count in COUNTS], axis=0)
    for count in COUNTS:
        excess = np.array(costs[count]) - best
        yield {
            "model": name,
            "starts": str(count),
            "cases": cases,
            "median_cost": float(np.median(costs[count])),
            "mean_excess": float(np.mean(excess)),
            "missed": float(np.mean(excess > 0.01 * best)),
            "milliseconds": 1000 * float(np.median(seconds[count])),
        }


@styled
def chart(rows, title):
    """Cases whose best minimum is missed, against time."""
    models = list(dict.fromkeys(row["model"] for row in rows))
    figure = new_figure(2.3 * len(models), 2.9)
    panels = figure.subplots(1, len(models), sharey=True, squeeze=False)[0]
    for axes, model in zip(panels, models, strict=True):
        own = [row for row in rows if row["model"] == model]
        times = [row["milliseconds"] for row in own]
        axes.plot(times, [100 * row["missed"] for row in own], "o-", color=COLOURS[0])
        for row in own:
            axes.annotate(
                row["starts"],
                (row["milliseconds"], 100 * row["missed"]),
                xytext=(3, 4),
                textcoords="offset points",
                size=7,
            )
        axes.set(xscale="log", title=model, ylim=(-4, 104))
        axes.set_xlim(min(times) / 1.3, 1.6 * max(times))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    panels[0].set_ylabel("best minimum missed [% of the cases]")
    figure.supxlabel(
        "time of one fit [ms], log scale (labels: starts; middle: one in the middle of "
        "the ranges)",
        size=9,
    )
    entitle(figure, title)
    return figure


def main(folder=RESULTS / "many_starts", cases=CASES):
    """Write the table and the figure."""
    record = Record(folder, SEED)
    rows = [row for name in MODELS for row in rows_of(name, cases)]
    record.table(rows)
    missed = {
        count: 100 * float(np.mean([r["missed"] for r in rows if r["starts"] == count]))
        for count in ("1", "16")
    }
    finding = (
        f"One start misses the best minimum on {missed['1']:.0f} % of the hard cases, "
        f"sixteen miss it on {missed['16']:.0f} %."
    )
    record.figure(chart(rows, finding))
    record.close(
        finding=finding,
        cases=cases,
        samples=len(GRID.directions()[0]),
        noise=NOISE,
    )


if __name__ == "__main__":
    main()
