"""How many directions does a light probe take, for which roughness and how long?

A sphere under a sky with a small sun, by growing numbers of directions, against every
pixel of the sky. The directions that a plan picks for a tolerance are marked, so that
it can be seen whether they meet it.
"""

import dataclasses

import numpy as np

from benchmarks.measure import use_one_core
from brdffit import plan
from brdffit.effects.quadrature import Regions, Rule, texels
from brdffit.models import GGX, Lambert
from brdffit.plots.style import COLOURS, DASHES, entitle, new_figure
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.scene import Environment, Orthographic, Scene, Sphere
from experiments.record import RESULTS, Record, styled
from experiments.tradeoff import Variant, measured as compared

RESOLUTION = 14
SKY = (128, 256)
NUMBERS = tuple(2**n for n in range(4, 16))
TOLERANCES = (1e-1, 1e-2, 1e-3)
ALPHAS = (0.05, 0.1, 0.2, 0.5)
RUNS = 7


def sky(rows, columns):
    """Blue above, brown below, with a sun of six degrees and a soft cloud."""
    v, u = (np.mgrid[0:rows, 0:columns] + 0.5) / [[[rows]], [[columns]]]
    x = np.sin(np.pi * v) * np.sin(2 * np.pi * u)
    y, z = np.cos(np.pi * v), -np.sin(np.pi * v) * np.cos(2 * np.pi * u)
    sun = 400 * np.exp(800 * (-0.48 * x + 0.6 * y + 0.64 * z - 1))
    cloud = 2 * np.exp(12 * (0.8 * x + 0.48 * y + 0.36 * z - 1))
    above = 1 / (1 + np.exp(-12 * y))
    ground = above[..., None] * [0.25, 0.4, 0.7] + (1 - above)[..., None] * [
        0.2,
        0.15,
        0.1,
    ]
    return ground + sun[..., None] * [1.0, 0.9, 0.7] + cloud[..., None]


def materials():
    """Matt, and ever smoother."""
    rough = {
        f"ggx, alpha {a:g}": GGX(diffuse=0.2, f0=[0.3] * 3, alpha=a) for a in ALPHAS
    }
    return {"lambert": Lambert(albedo=[0.5] * 3)} | rough


def measured(resolution, numbers):
    """Rows of the two tables."""
    probe = Environment(sky(*SKY))
    scene = Scene(Orthographic(resolution), (Sphere(),), (probe,))
    light, direction = texels(probe)
    every = Rule(direction.reshape(-1, 3), light.reshape(-1, 3))
    regions, rows, picked = Regions(probe), [], []
    for name, brdf in materials().items():
        made = plan(scene, brdf, tolerance=1.0, with_=["environment"])
        whole = dataclasses.replace(made, sky=every)
        truth = np.asarray(compiled_shade(brdf, trace(scene, whole)))

        def error(value, truth=truth):
            return float(np.sqrt(np.mean((value - truth) ** 2) / np.mean(truth**2)))

        variants = []
        for number in numbers:
            rule = dataclasses.replace(made, sky=regions.rule(number))

            def run(brdf=brdf, rule=rule):
                return np.asarray(compiled_shade(brdf, trace(scene, rule)))

            variants.append(Variant(str(number), run, error, "directions"))
        for row, number in zip(compared(name, variants, RUNS), numbers, strict=True):
            rows.append(
                {
                    "model": name,
                    "directions": number,
                    "error": row["error"],
                    "milliseconds": 1000 * row["seconds"],
                }
            )
        for tolerance in TOLERANCES:
            chosen = plan(scene, brdf, tolerance=tolerance)
            value = np.asarray(compiled_shade(brdf, trace(scene, chosen)))
            told = "or above it" in chosen.decisions["environment"].why
            picked.append(
                {
                    "model": name,
                    "tolerance": tolerance,
                    "directions": chosen.directions,
                    "error": error(value),
                    "said_to_be_met": not told,
                }
            )
    return rows, picked


def finding(picked):
    """How often the plan keeps its word, and at what number of directions."""
    met = sum(row["error"] <= row["tolerance"] for row in picked)
    said = sum(row["said_to_be_met"] for row in picked)
    numbers = [row["directions"] for row in picked]
    return (
        f"The plan meets {met} of {len(picked)} tolerances, and says so of {said}, "
        f"with {min(numbers):,} to {max(numbers):,} directions"
    )


@styled
def chart(rows, picked, words):
    """Error against directions and against time."""
    figure = new_figure(7.6, 4.2)
    left, right = figure.subplots(1, 2, sharey=True)
    names = list(dict.fromkeys(row["model"] for row in rows))
    for n, name in enumerate(names):
        own = [row for row in rows if row["model"] == name]
        look = {"color": COLOURS[n], "linestyle": DASHES[n]}
        error = [row["error"] or np.nan for row in own]  # none on a log scale
        left.plot([row["directions"] for row in own], error, label=name, **look)
        right.plot([row["milliseconds"] for row in own], error, **look)
        chosen = [row for row in picked if row["model"] == name]
        left.plot(
            [row["directions"] for row in chosen],
            [row["error"] for row in chosen],
            "o",
            color=COLOURS[n],
        )
    exact = [row["directions"] for row in picked if not row["error"]]
    left.plot(
        exact,
        [0.03] * len(exact),
        "kv",
        markerfacecolor="none",
        transform=left.get_xaxis_transform(),
        label="every pixel: no error" if exact else None,
    )
    for tolerance in TOLERANCES:
        label = "tolerance" if tolerance == TOLERANCES[0] else None
        left.axhline(tolerance, color="#6b6b6b", linewidth=0.7, label=label)
    left.set(
        xscale="log",
        yscale="log",
        xlabel="directions, log scale (dots: picked by a plan)",
    )
    left.set_ylabel("error of the image (relative RMS), log scale")
    right.set(xscale="log", xlabel="time to trace and shade [ms], log scale")
    figure.legend(
        *left.get_legend_handles_labels(), loc="outside lower center", ncols=3
    )
    entitle(figure, words)
    return figure


def main(folder=RESULTS / "probe_directions", resolution=RESOLUTION, numbers=NUMBERS):
    """Write tables and figure."""
    record = Record(folder)
    rows, picked = measured(resolution, numbers)
    record.table(rows)
    record.table(picked, "picked")
    words = finding(picked)
    record.figure(chart(rows, picked, words))
    record.close(finding=f"{words}.", resolution=resolution, sky=list(SKY), turns=RUNS)


if __name__ == "__main__":
    use_one_core()
    main()
