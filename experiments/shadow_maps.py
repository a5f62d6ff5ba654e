"""How do shadow maps come closer to the exact shadow, and at what price?

A sphere over a floor under a directional light and under a point light, with rays and
with maps of growing resolution. The error is the root mean square of the difference
from the image with rays, relative to it; the time is that of finding the visibility of
all pixels, the least of five.
"""

import time

import numpy as np

from brdffit import plan, render
from brdffit.effects import shadows
from brdffit.effects.lights import incident
from brdffit.models import Lambert
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import COLOURS, DASHES, new_figure
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
from experiments.record import RESULTS, Record, styled

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


def seconds(view):
    """Time of finding what every pixel sees of the light."""
    geometry = Geometry(view.shapes)
    hits = geometry.first_hits(*view.camera.rays())
    light = incident(view, hits.position, 3, None)
    taken = []
    for run in range(RUNS + 1):  # the first one compiles
        begin = time.perf_counter()
        shadows.visibility(geometry, geometry.first_hits, hits, light, view)
        if run:
            taken.append(time.perf_counter() - begin)
    return min(taken)


def measured(resolution):
    """Images and rows of the table."""
    images, rows = {}, []
    for name, light in LIGHTS.items():
        truth = None
        for size in (0, *MAPS):
            how = ShadowMap(size) if size else ShadowRays()
            view = scene(light, how, resolution)
            made = plan(view, GREY, with_=["shadows"])
            image = render(GREY, view, made)
            truth = image if truth is None else truth
            error = np.sqrt(np.mean((image - truth) ** 2) / np.mean(truth**2))
            images[name, size] = image
            rows.append(
                {
                    "light": name,
                    "method": "map" if size else "rays",
                    "resolution": size or "",
                    "error": float(error),
                    "milliseconds": 1000 * seconds(view),
                }
            )
        bare = plan(scene(light, ShadowRays(), resolution), GREY, without=["shadows"])
        images[name, None] = render(GREY, scene(light, ShadowRays(), resolution), bare)
    return images, rows


@styled
def chart(images, rows):
    """Pictures above, error against time below."""
    figure = new_figure(7.6, 6.6)
    above, below = figure.subfigures(2, 1, height_ratios=(1.25, 1))
    grid = above.subplots(2, 4)
    shown = {None: "no shadow", 0: "rays", SHOWN: f"map, {SHOWN}", 256: "map, 256"}
    for line, name in zip(grid, LIGHTS, strict=True):
        for axes, (size, title) in zip(line, shown.items(), strict=True):
            plot_sphere(axes, images[name, size], 0.8)
            axes.set_title(f"{name}: {title}")
    against, time_axes = below.subplots(1, 2, sharey=True)
    for n, name in enumerate(LIGHTS):
        maps = [r for r in rows if r["light"] == name and r["method"] == "map"]
        (exact,) = (r for r in rows if r["light"] == name and r["method"] == "rays")
        look = {"color": COLOURS[n], "linestyle": DASHES[n], "marker": "o"}
        error = [r["error"] for r in maps]
        against.plot([r["resolution"] for r in maps], error, label=name, **look)
        time_axes.plot([r["milliseconds"] for r in maps], error, **look)
        time_axes.axvline(exact["milliseconds"], color=COLOURS[n], linestyle=DASHES[n])
    against.set(xscale="log", yscale="log", xlabel="pixels along a side of the map")
    against.set_xticks(MAPS, [str(size) for size in MAPS])
    against.minorticks_off()
    against.set_ylabel("error of the image (relative RMS)")
    against.legend()
    time_axes.set(xscale="log", yscale="log")
    time_axes.set_xlabel("time to find visibility (ms); upright: exact rays")
    figure.suptitle("A sphere over a floor: shadow maps against exact shadows")
    return figure


def main(folder=RESULTS / "shadow_maps", resolution=RESOLUTION):
    """Write table and figure."""
    record = Record(folder)
    images, rows = measured(resolution)
    record.table(rows)
    record.figure(chart(images, rows))
    record.close(resolution=resolution, runs=RUNS)


if __name__ == "__main__":
    main()
