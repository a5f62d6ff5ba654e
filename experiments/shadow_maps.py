"""How do shadow maps come closer to the exact shadow, and at what price?

A sphere over a floor under a directional light and under a point light, with rays and
with maps of growing resolution. The error is the root mean square of the difference
from the image with rays, relative to it; the time is that of finding the visibility of
all pixels, on one core.
"""

import numpy as np

from benchmarks.measure import use_one_core
from brdffit import plan, render
from brdffit.effects import shadows
from brdffit.effects.lights import incident
from brdffit.models import Lambert
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import entitle, new_figure
from brdffit.scene import (
    Directional,
    Geometry,
    Perspective,
    Plane,
    Point,
    Scene,
    ShadowMap,
    ShadowRays,
    Sphere,
)
from experiments.pareto import chart
from experiments.record import RESULTS, Record, styled
from experiments.tradeoff import (
    Variant,
    measured as compared,
    root_mean_square,
    rounded,
    saved,
)

RESOLUTION = 192
MAPS = (16, 32, 64, 128, 256, 512, 1024)
SHOWN = 32
RUNS = 5
GREY = Lambert(albedo=[0.6] * 3)
LIGHTS = {
    "directional": Directional([0.48, 0.6, 0.64], np.pi),
    "point": Point([1.5, 2.0, 2.0], 30.0),
}


def scene(light, how, resolution):
    """A sphere over a floor."""
    camera = Perspective(resolution, position=[0, 1.6, 6.0], target=[-0.3, -0.3, 0])
    shapes = (Sphere(), Plane([0, -1.1, 0]))
    return Scene(camera, shapes, (light,), shadows=how)


def visibility(view):
    """What finds out what every pixel sees of the light."""
    geometry = Geometry(view.shapes)
    hits = geometry.first_hits(*view.camera.rays())
    light = incident(view.lights, hits.position, 3, None)
    return lambda: shadows.visibility(geometry, geometry.first_hits, hits, light, view)


def measured(resolution):
    """Images and rows of the table."""
    images, rows = {}, []
    for name, light in LIGHTS.items():
        variants = []
        for size in (0, *MAPS):
            view = scene(light, ShadowMap(size) if size else ShadowRays(), resolution)
            images[name, size] = render(GREY, view, plan(view, GREY, with_=["shadows"]))
            wrong = root_mean_square(images[name, 0])(images[name, size])
            variants.append(
                Variant(
                    f"map, {size} px" if size else "rays",
                    visibility(view),
                    lambda _, wrong=wrong: wrong,
                    "map" if size else "rays",
                )
            )
        rows += compared(name, variants, RUNS)
        bare = plan(scene(light, ShadowRays(), resolution), GREY, without=["shadows"])
        images[name, None] = render(GREY, scene(light, ShadowRays(), resolution), bare)
    return images, rows


def finding(rows):
    """What the finest map leaves, and whether it is faster than rays, as a sentence."""
    said = []
    for name in LIGHTS:
        rays, *maps = [row for row in rows if row["question"] == name]
        best = min(maps, key=lambda row: row["error"])
        said.append(
            f"under a {name} light a {best['variant']} leaves "
            f"{rounded(100 * best['error'])} % and {saved(best, rays)}"
        )
    return f"Beside exact rays, {'; '.join(said)}"


@styled
def pictures(images):
    """Shadows without, by rays and by two maps."""
    figure = new_figure(7.6, 4.2)
    grid = figure.subplots(2, 4)
    shown = {
        None: "no shadow",
        0: "rays",
        SHOWN: f"map, {SHOWN} px",
        256: "map, 256 px",
    }
    for line, name in zip(grid, LIGHTS, strict=True):
        for axes, (size, title) in zip(line, shown.items(), strict=True):
            plot_sphere(axes, images[name, size], 0.8)
            axes.set_title(f"{name}: {title}")
    entitle(
        figure,
        f"The edge of a shadow has steps in a map of {SHOWN} pixels, and hardly in one "
        "of 256",
    )
    return figure


def main(folder=RESULTS / "shadow_maps", resolution=RESOLUTION):
    """Write table, curve and pictures."""
    record = Record(folder)
    images, rows = measured(resolution)
    record.table(rows)
    words = finding(rows)
    figure = chart(
        rows,
        {name: f"{name} light" for name in LIGHTS},
        words,
        unit="ms",
        error="error of the image (relative RMS)",
        time_of="finding visibility",
        panel=(4.2, 3.3),
    )
    record.figure(figure)
    record.figure(pictures(images), "pictures")
    record.close(finding=f"{words}.", resolution=resolution, turns=RUNS)


if __name__ == "__main__":
    use_one_core()
    main()
