"""Does the 95 % interval of a fit hold the truth in 95 % of all noisy repetitions?

One truth per model on a goniometer grid that determines all its parameters, off their
bounds; 1 % noise, drawn anew with a fixed seed each time. The interval is the estimate
plus and minus 1.96 standard errors. A share of 1,000 repetitions is itself known to
0.7 percentage points. `z_deviation` is the scatter of the estimates in their own
standard errors, which should be 1.

    python -m experiments.coverage
"""

import jax.numpy as jnp
import numpy as np

import brdffit
from brdffit import Goniometer, Noise, simulate_measurement
from brdffit.models import MODELS
from brdffit.plots.style import COLOURS, MUTED, entitle, new_figure
from experiments.record import RESULTS, Record, styled

REFITS = 1000
ASKED = (93, 97)  # % of repetitions that an honest interval of 95 % holds
SEED = 11
NOISE = 0.01  # relative
NORMAL_95 = 1.959964
GRID = Goniometer(
    theta_i=(8, 25, 45, 65), theta_o=np.arange(2, 86, 7), phi=(0, 60, 120, 165, 180)
)
TRUTHS = {
    "ggx": {"diffuse": (0.3, 0.2, 0.1), "f0": (0.06, 0.05, 0.04), "alpha": 0.25},
    "oren_nayar": {"albedo": (0.6, 0.4, 0.2), "sigma": 0.35},
    "phong": {
        "diffuse": (0.3, 0.2, 0.1),
        "specular": (0.2, 0.25, 0.3),
        "exponent": 30.0,
    },
    "cook_torrance": {
        "diffuse": (0.3, 0.2, 0.1),
        "specular": (0.5, 0.4, 0.6),
        "f0": 0.15,
        "alpha": 0.3,
    },
}


def deviations(name, count, starts=2):
    """``(estimate - truth) / standard error`` of every parameter and repetition."""
    truth = TRUTHS[name]
    brdf = MODELS[name](**{n: jnp.asarray(v) for n, v in truth.items()})
    found = {}
    for seed in range(count):
        data = simulate_measurement(brdf, GRID, Noise(NOISE, seed=SEED + seed))
        result = brdffit.fit(name, data, residual="plain", starts=starts)
        for parameter, value in truth.items():
            away = result.parameters[parameter] - np.array(value)
            z = np.atleast_1d(away / result.standard_errors[parameter])
            for place, number in enumerate(z):
                label = parameter if len(z) == 1 else f"{parameter}[{place}]"
                found.setdefault(label, []).append(number)
    return {label: np.array(z) for label, z in found.items()}


def rows_of(name, count):
    """A row for each parameter."""
    for label, z in deviations(name, count).items():
        yield {
            "model": name,
            "parameter": label,
            "refits": count,
            "coverage": float(np.mean(np.abs(z) <= NORMAL_95)),
            "z_mean": float(np.mean(z)),
            "z_deviation": float(np.std(z)),
        }


@styled
def chart(rows, title):
    """How often each interval holds the truth, and the band that is asked for."""
    figure = new_figure(7.0, 0.9 + 0.19 * len(rows))
    axes = figure.subplots()
    names = [f"{row['model']} {row['parameter']}" for row in rows]
    models = list(dict.fromkeys(row["model"] for row in rows))
    axes.axvspan(*ASKED, color=MUTED, alpha=0.15, lw=0, label="asked for")
    axes.axvline(95, color=MUTED, lw=0.8)
    for model, colour, mark in zip(models, COLOURS, "os^D", strict=False):
        own = [
            (100 * row["coverage"], f"{model} {row['parameter']}")
            for row in rows
            if row["model"] == model
        ]
        axes.plot(*zip(*own, strict=True), mark, color=colour, ms=4, label=model)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xlabel("repetitions whose 95 % interval holds the truth [%]")
    figure.legend(loc="outside lower center", ncols=5)
    entitle(figure, title)
    return figure


def main(folder=RESULTS / "coverage", count=REFITS):
    """Write the table and the figure."""
    record = Record(folder, SEED)
    rows = [row for name in TRUTHS for row in rows_of(name, count)]
    record.table(rows)
    shares = [100 * row["coverage"] for row in rows]
    finding = (
        f"The 95 % intervals of {len(rows)} parameters hold the truth in "
        f"{min(shares):.1f} to {max(shares):.1f} % of {count:,} repetitions."
    )
    record.figure(chart(rows, finding))
    record.close(
        finding=finding,
        refits=count,
        samples=len(GRID.directions()[0]),
        noise=NOISE,
    )


if __name__ == "__main__":
    main()
