"""What does each effect of a scene change in the image, and what does it take?

One scene that calls for every effect of a scene but style, which makes another picture
altogether: a bumpy anisotropic sphere, one with holes, a mirror and glass over a floor,
under a point light, ambient light and a light probe. Each effect is left out in turn.
Effects of a model are added to GGX facets on a lone sphere: exact Fresnel, and light
that facets reflect again. The change is the root mean square of the difference of the
image over that of the image with all effects; the time is that of a whole picture,
compiled, on one core.
"""

import numpy as np

from benchmarks.measure import use_one_core
from benchmarks.problems import LIGHTS
from brdffit import lit_sphere, plan, render
from brdffit.models import GGX, GGXAnisotropic, Lambert
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import entitle, new_figure
from brdffit.scene import (
    Ambient,
    Environment,
    Glass,
    HeightMap,
    Mirror,
    OpacityMap,
    Perspective,
    Plane,
    Point,
    Scene,
    Sphere,
)
from experiments.classic_scenes import sky
from experiments.pareto import chart
from experiments.record import RESULTS, Record, styled
from experiments.tradeoff import Variant, measured, root_mean_square, rounded

RESOLUTION, ROUGH_RESOLUTION = 112, 512
BRIGHTEST = 1.5  # radiance of the sky
DIRECTIONS_TOLERANCE = 0.3  # of the light probe
TURNS = 3
SCENE_EFFECTS = (
    *("ambient", "falloff", "tangents", "bump", "cut_out", "shadows"),
    *("environment", "bounces"),
)
MODEL_EFFECTS = ("multiple_scattering", "exact_fresnel")
WHOLE = "all effects"
BRDF = {"diffuse": [0.05, 0.15, 0.35], "f0": [0.3] * 3, "alpha_x": 0.1, "alpha_y": 0.4}
FACETS = {"diffuse": [0.0] * 3, "f0": [0.95, 0.7, 0.4], "alpha": 0.5}


def scene(resolution):
    """Everything at once."""
    v, u = (np.mgrid[0:128, 0:256] + 0.5) / [[[128]], [[256]]]
    waves = np.sin(24 * np.pi * u) * np.sin(12 * np.pi * v) * np.sin(np.pi * v)
    holes = (np.sin(12 * np.pi * u) * np.sin(6 * np.pi * v) < 0.6).astype(float)
    shapes = (
        Sphere([-1.1, 0, 0], 0.9, height=HeightMap(waves, scale=0.02)),
        Sphere([1.0, 0.1, -0.9], 0.9, material=Mirror()),
        Sphere([1.1, -0.5, 1.0], 0.45, material=Glass(1.5)),
        Sphere([-0.1, -0.45, 1.2], 0.45, opacity=OpacityMap(holes)),
        Plane([0, -0.95, 0], material=Lambert(albedo=[0.4] * 3)),
    )
    lights = (
        Point([2.0, 3.5, 2.5], [20.0, 19.0, 17.0]),
        Ambient([0.05, 0.05, 0.06]),
        Environment(np.minimum(sky(32, 64), BRIGHTEST)),  # the sun is the point light
    )
    camera = Perspective(resolution, position=[0, 1.0, 6.0], target=[0, -0.15, 0])
    return Scene(camera, shapes, lights)


def picture(name, brdf, view, images, **options):
    """A variant that renders and keeps its first picture; the first one is right."""
    made = plan(view, brdf, tolerance=DIRECTIONS_TOLERANCE, **options)

    def error(image):
        images[name] = image
        return root_mean_square(next(iter(images.values())))(image)

    return Variant(name, lambda: render(brdf, view, made), error)


def scene_rows(resolution, turns):
    """Lines and pictures of the scene, each effect left out."""
    view, brdf, images = scene(resolution), GGXAnisotropic(**BRDF), {}
    variants = [picture(WHOLE, brdf, view, images, with_=SCENE_EFFECTS)]
    for effect in SCENE_EFFECTS:
        others = [other for other in SCENE_EFFECTS if other != effect]
        options = {"with_": others, "without": [effect]}
        variants.append(picture(without(effect), brdf, view, images, **options))
    return measured("scene", variants, turns), images


def model_rows(resolution, turns):
    """Lines of the effects of a model, with and without."""
    view, brdf, rows = lit_sphere(resolution, LIGHTS), GGX(**FACETS), []
    for effect in MODEL_EFFECTS:
        images = {}
        whole = picture("with the effect", brdf, view, images, with_=[effect])
        bare = picture(without(effect), brdf, view, images)
        rows += measured(effect, [whole, bare], turns)
    return rows


def without(effect):
    """What a picture without an effect is called."""
    return f"no {effect.replace('_', ' ')}"


def title(rows, question):
    """What the dearest effect of a question takes, and what it changes."""
    own = [row for row in rows if row["question"] == question]
    whole, least = own[0], min(own[1:], key=lambda row: row["seconds"])
    share = 100 * (1 - least["seconds"] / whole["seconds"])
    return (
        f"{question.replace('_', ' ')}: {least['variant']}\nsaves {share:.0f} % of "
        f"the time, changes {rounded(100 * least['error'])} %"
    )


def finding(rows):
    """What gives most change for its time, and what least, as a sentence."""
    whole, *others = [row for row in rows if row["question"] == "scene"]
    most = max(others, key=lambda row: row["error"])
    dear = min(others, key=lambda row: row["seconds"])
    share = 100 * (1 - dear["seconds"] / whole["seconds"])
    changes = f"{most['variant'][3:]}, by {rounded(100 * most['error'])} %"
    takes = f"{dear['variant'][3:]}, {share:.0f} % of it"
    return (
        f"Of {len(others)} effects of a scene the one that changes the image most is "
        f"{changes}; the one that takes most of the time is {takes}"
    )


@styled
def sheet(images, rows):
    """The scene without each effect."""
    by = {row["variant"]: row for row in rows}
    columns = 3
    lines = -(-len(images) // columns)
    figure = new_figure(2.4 * columns, 2.65 * lines + 0.5)
    panels = figure.subplots(lines, columns, squeeze=False).ravel()
    for axes in panels:
        axes.set_axis_off()
    for axes, (name, image) in zip(panels, images.items(), strict=False):
        plot_sphere(axes, image, 0.9)
        row = by[name]
        axes.set_title(
            f"{name}\n{rounded(1000 * row['seconds'])} ms, "
            f"change {rounded(100 * row['error'])} %"
        )
    entitle(figure, finding(rows))
    return figure


def main(
    folder=RESULTS / "effect_cost",
    resolution=RESOLUTION,
    rough_resolution=ROUGH_RESOLUTION,
    turns=TURNS,
):
    """Write table, curve and pictures."""
    record = Record(folder)
    rows, images = scene_rows(resolution, turns)
    rows += model_rows(rough_resolution, turns)
    record.table(rows)
    questions = dict.fromkeys(row["question"] for row in rows)
    figure = chart(
        rows,
        {question: title(rows, question) for question in questions},
        finding(rows),
        unit="ms",
        error="change of the image (relative RMS)",
        time_of="a picture",
    )
    record.figure(figure)
    record.figure(sheet(images, rows), "pictures")
    record.close(finding=finding(rows) + ".", resolution=resolution, turns=turns)


if __name__ == "__main__":
    use_one_core()
    main()
