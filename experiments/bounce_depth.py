"""How deep must mirrors and glass be followed, and how long does that take?

Two mirrors and glass between walls, and a mirror in the Cornell box, with rays followed
to a growing depth. The error is the root mean square of the difference from the image
at the greatest depth over that of the image, the time that of a whole picture,
compiled, on one core.
"""

import dataclasses

from benchmarks.measure import use_one_core
from brdffit import plan, render
from brdffit.models import GGX, Lambert
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import entitle, new_figure
from brdffit.scene import (
    Ambient,
    Glass,
    Mirror,
    Perspective,
    Plane,
    Point,
    Scene,
    Sphere,
)
from experiments.classic_scenes import cornell
from experiments.pareto import chart
from experiments.record import RESULTS, Record, styled
from experiments.tradeoff import Variant, measured, root_mean_square

RESOLUTION = 128
DEPTHS = (0, 1, 2, 3, 4, 6, 8)
DEEPEST = 12
ENOUGH = 0.01  # error of an image
LEAST = 1e-7  # the least error of single precision
TURNS = 3
BRDF = GGX(diffuse=[0.05, 0.15, 0.35], f0=[0.04] * 3, alpha=0.25)


def between_mirrors(resolution):
    """Two mirrors that see each other, glass and a matt ball."""
    shapes = (
        Sphere([-1.0, -0.1, 0], 0.9, material=Mirror()),
        Sphere([1.0, -0.1, 0], 0.9, material=Mirror()),
        Sphere([0, -0.55, 1.4], 0.45, material=Glass(1.5)),
        Sphere([0, -0.6, -1.6], 0.4),
        Plane([0, -1, 0], material=Lambert(albedo=[0.4] * 3)),
        Plane([0, 0, -3], [0, 0, 1], material=Lambert(albedo=[0.6, 0.35, 0.2])),
        Plane([0, 0, 7], [0, 0, -1], material=Lambert(albedo=[0.2, 0.45, 0.6])),
    )
    lights = (Point([1.5, 3.0, 3.5], [30.0, 29.0, 27.0]), Ambient([0.2, 0.22, 0.25]))
    camera = Perspective(resolution, position=[0, 1.0, 5.5], target=[0, -0.3, 0])
    return Scene(camera, shapes, lights)


def rows_of(question, view, depths, turns):
    """Lines of one scene, and its pictures."""
    images, variants = {}, []
    for depth in (DEEPEST, *depths):
        here = dataclasses.replace(view, depth=depth)
        made = plan(here, BRDF, tolerance=1e-9)

        def run(here=here, made=made):
            return render(BRDF, here, made)

        def error(image, depth=depth):
            images[depth] = image
            if depth == DEEPEST:
                return 0.0
            return max(root_mean_square(images[DEEPEST])(image), LEAST)

        family = "depth" if depth != DEEPEST else "deepest"
        variants.append(Variant(f"depth {depth}", run, error, family))
    return measured(question, variants, turns), images


def title(rows):
    """The least depth that leaves less than a hundredth."""
    deepest, *others = rows
    enough = next((row for row in others if row["error"] < ENOUGH), deepest)
    left = 100 * enough["error"]
    return (
        f"{deepest['question']}: {enough['variant']} leaves "
        f"{f'{left:.2g}' if left >= 0.01 else 'less than 0.01'} %\nin "
        f"{100 * enough['seconds'] / deepest['seconds']:.0f} % of the time of "
        f"{deepest['variant']}"
    )


def finding(found):
    """The depths that are enough, as a sentence."""
    return "; ".join(title(rows).replace("\n", " ") for rows in found.values())


@styled
def sheet(images, words):
    """One scene at growing depths."""
    figure = new_figure(1.9 * len(images), 2.5)
    panels = figure.subplots(1, len(images))
    for axes, (depth, image) in zip(panels, images.items(), strict=True):
        plot_sphere(axes, image, 0.9)
        axes.set_title(f"depth {depth}")
    entitle(figure, words)
    return figure


def main(
    folder=RESULTS / "bounce_depth", resolution=RESOLUTION, depths=DEPTHS, turns=TURNS
):
    """Write table, curve and pictures."""
    record, found, shown = Record(folder), {}, None
    for question, view in {
        "mirrors and glass": between_mirrors(resolution),
        "Cornell box": cornell(resolution, 0.12, True),
    }.items():
        found[question], images = rows_of(question, view, depths, turns)
        shown = shown or {depth: images[depth] for depth in (*depths[:4], DEEPEST)}
    rows = [row for own in found.values() for row in own]
    record.table(rows)
    figure = chart(
        rows,
        {question: title(own) for question, own in found.items()},
        finding(found),
        unit="ms",
        error="error of the image (relative RMS)",
        time_of="a picture",
        panel=(4.2, 3.3),
    )
    record.figure(figure)
    first = next(iter(found.values()))
    words = title(first).replace("\n", " ")
    record.figure(sheet(shown, words), "pictures")
    record.close(finding=finding(found) + ".", resolution=resolution, turns=turns)


if __name__ == "__main__":
    use_one_core()
    main()
