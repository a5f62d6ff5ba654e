"""How do six materials look in one lit scene, and at what price?

Spheres of Phong, Oren-Nayar, and a conductor and a dielectric with GGX and Beckmann
facets, over a floor under a directional light, a point light and a little ambient
light, at 1024 x 1024 pixels. The time is that of a whole picture whose programs are
compiled, on one core. Beside it stand the seconds that a published student renderer
needed for the like, in the order in which it lists the six; machine and scene are not
the same, so that only the times relative to Phong's compare.
"""

import numpy as np

from benchmarks.measure import use_one_core
from brdffit import optics, plan, render
from brdffit.models import (
    ConductorBeckmann,
    DielectricBeckmann,
    DielectricGGX,
    Lambert,
    OrenNayar,
    Phong,
)
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import COLOURS, NO_DATA, entitle, new_figure
from brdffit.scene import (
    Ambient,
    Directional,
    Perspective,
    Plane,
    Point,
    Scene,
    Sphere,
)
from experiments.record import RESULTS, Record, styled
from experiments.tradeoff import Variant, measured

RESOLUTION = 1024
METAL, ALPHA = "Au", 0.2
TURNS = 5
PUBLISHED = (6.9, 11.2, 191.0, 12.4, 12.1, 12.0)  # seconds, in the order of `materials`


def materials():
    """The six, by name."""
    gold = optics.conductor(METAL, ALPHA)
    index = {"eta": gold.eta, "k": gold.k}
    base = Lambert(albedo=[0.04, 0.1, 0.16])
    return {
        "phong": Phong(diffuse=[0.1, 0.25, 0.4], specular=0.3, exponent=60.0),
        "oren_nayar": OrenNayar(albedo=[0.1, 0.25, 0.4], sigma=0.5),
        "conductor_ggx": gold,
        "conductor_beckmann": ConductorBeckmann(alpha=ALPHA, **index),
        "lambert+dielectric_ggx": base + DielectricGGX(eta=1.5, alpha=ALPHA),
        "lambert+dielectric_beckmann": base + DielectricBeckmann(eta=1.5, alpha=ALPHA),
    }


def scene(resolution):
    """A sphere on a floor under three lights."""
    return Scene(
        Perspective(resolution, position=[0, 0.9, 5.2], target=[0, -0.05, 0]),
        (Sphere(), Plane([0, -1, 0], material=Lambert(albedo=[0.35] * 3))),
        (
            Directional([-0.48, 0.64, 0.6], [2.0, 1.9, 1.7]),
            Point([2.5, 2.5, 2.5], [9.0, 10.0, 12.0]),
            Ambient([0.08, 0.09, 0.1]),
        ),
    )


def pictures(view):
    """A picture of each, the effects in it, and its line of the table."""
    variants, shown = [], {}
    for name, brdf in materials().items():
        made = plan(view, brdf)
        effects = " ".join(effect for effect in made.decisions if made.on(effect))

        def run(brdf=brdf, made=made):
            return render(brdf, view, made)

        def error(image, name=name, effects=effects):
            shown[name] = image, effects
            return 0.0  # they are different materials

        variants.append(Variant(name, run, error))
    return shown, measured("six materials", variants, TURNS)


def table(shown, rows):
    """Times, and how they compare with that of Phong."""
    return [
        {
            "model": row["variant"],
            "seconds": row["seconds"],
            "lower_quartile": row["lower_quartile"],
            "upper_quartile": row["upper_quartile"],
            "over_phong": row["seconds"] / rows[0]["seconds"],
            "published_seconds": published,
            "published_over_phong": published / PUBLISHED[0],
            "effects": shown[row["variant"]][1],
            "mean_radiance": float(shown[row["variant"]][0].mean()),
        }
        for row, published in zip(rows, PUBLISHED, strict=True)
    ]


def finding(lines):
    """The dearest of the six in both renderers, as a sentence."""
    ours = max(lines, key=lambda line: line["over_phong"])
    theirs = max(lines, key=lambda line: line["published_over_phong"])
    return (
        f"The dearest of six materials, {ours['model']}, takes "
        f"{ours['over_phong']:.1f} times as long as Phong; in the published renderer "
        f"the dearest took {theirs['published_over_phong']:.0f} times as long"
    )


@styled
def sheet(shown, lines):
    """Six pictures, and their times relative to Phong."""
    figure = new_figure(9.6, 5.4)
    spheres, chart = figure.subfigures(1, 2, width_ratios=(1.75, 1))
    for axes, line in zip(spheres.subplots(2, 3).flat, lines, strict=True):
        plot_sphere(axes, shown[line["model"]][0], 0.9)
        axes.set_title(f"{line['model']}\n{line['seconds']:.2f} s")
    axes = chart.subplots()
    places = np.arange(len(lines))
    for shift, key, colour, hatch, label in (
        (-0.2, "over_phong", COLOURS[0], "", "brdffit"),
        (0.2, "published_over_phong", NO_DATA, "///", "published renderer"),
    ):
        values = [line[key] for line in lines]
        axes.barh(
            places + shift,
            values,
            0.38,
            color=colour,
            hatch=hatch,
            edgecolor="white",
            label=label,
        )
        for place, value in zip(places + shift, values, strict=True):
            axes.text(1.04 * value, place, f"{value:.3g}", size=7, va="center")
    names = [line["model"].replace("+", " +\n") for line in lines]
    axes.set_yticks(places, names)
    axes.set(xscale="log", ylim=(len(lines) - 0.5, -0.5), xlim=(0.5, 80))
    axes.set_xticks(
        [0.5, 1, 2, 5, 10, 20, 50], ["0.5", "1", "2", "5", "10", "20", "50"]
    )
    axes.minorticks_off()
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("time over Phong's, log scale")
    chart.legend(loc="outside lower center", ncols=2, fontsize=8)
    entitle(figure, finding(lines))
    return figure


def main(folder=RESULTS / "six_materials", resolution=RESOLUTION):
    """Write table and sheet."""
    record = Record(folder)
    shown, rows = pictures(scene(resolution))
    lines = table(shown, rows)
    record.table(lines)
    record.figure(sheet(shown, lines))
    record.close(
        finding=finding(lines) + ".",
        resolution=resolution,
        metal=METAL,
        alpha=ALPHA,
        turns=TURNS,
    )


if __name__ == "__main__":
    use_one_core()
    main()
