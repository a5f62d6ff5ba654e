"""How do six materials look in one lit scene, and how long does each take?

Spheres of Phong, Oren-Nayar, and a conductor and a dielectric with GGX and Beckmann
facets, over a floor under a directional light, a point light and a little ambient
light. The time is that of a picture whose programs are compiled, the median of five.
"""

import time

import numpy as np

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
from brdffit.plots.style import new_figure
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

RESOLUTION = 256
METAL, ALPHA = "Au", 0.2
RUNS = 5


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


def timed(brdf, view):
    """A picture, the effects in it, and the seconds it takes."""
    made = plan(view, brdf)
    image, taken = render(brdf, view, made), []
    for _ in range(RUNS):
        begin = time.perf_counter()
        image = render(brdf, view, made)
        taken.append(time.perf_counter() - begin)
    return image, made, float(np.median(taken))


@styled
def sheet(pictures):
    """Two rows of three."""
    figure = new_figure(7.6, 5.6)
    for axes, (name, (image, _, seconds)) in zip(
        figure.subplots(2, 3).flat, pictures.items(), strict=True
    ):
        plot_sphere(axes, image, 0.9)
        axes.set_title(f"{name}\n{1000 * seconds:.0f} ms")
    rows, columns = image.shape[:2]
    figure.suptitle(
        "One scene, six materials: directional, point and ambient light, exact "
        f"shadows\n{rows} x {columns} pixels, time of a picture after compilation"
    )
    return figure


def main(folder=RESULTS / "six_materials", resolution=RESOLUTION):
    """Write table and sheet."""
    record = Record(folder)
    view = scene(resolution)
    pictures = {name: timed(brdf, view) for name, brdf in materials().items()}
    record.table(
        [
            {
                "model": name,
                "milliseconds": 1000 * seconds,
                "effects": " ".join(e for e in made.decisions if made.on(e)),
                "mean_radiance": float(image.mean()),
            }
            for name, (image, made, seconds) in pictures.items()
        ]
    )
    record.figure(sheet(pictures))
    record.close(resolution=resolution, metal=METAL, alpha=ALPHA, runs=RUNS)


if __name__ == "__main__":
    main()
