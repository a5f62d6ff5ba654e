"""What do the classic scenes of ray tracing look like, and how long does each take?

Mirror and glass in a light probe; the Cornell box with shadows and ambient light; local
shading beside traced shading; bumps that grow; Gooch's style. Times are medians of
a few pictures whose programs are compiled.
"""

import operator
import statistics
import time

import numpy as np
import trimesh

from brdffit import optics, plan, render
from brdffit.models import GGX, Lambert
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import entitle, new_figure
from brdffit.scene import (
    Ambient,
    Directional,
    Environment,
    Glass,
    Gooch,
    HeightMap,
    Mesh,
    Mirror,
    Orthographic,
    Perspective,
    Plane,
    Point,
    Scene,
    Sphere,
)
from experiments.record import RESULTS, Record, styled

RESOLUTION = 192
TURNS = 5
BLUE = GGX(diffuse=[0.05, 0.15, 0.35], f0=[0.04] * 3, alpha=0.25)
GREY = Lambert(albedo=[0.5] * 3)
SUN = Directional([-0.48, 0.6, 0.64], np.pi)
HEIGHTS = (0.0, 0.005, 0.01, 0.02, 0.04)


def sky(rows=128, columns=256):
    """Blue above, a chequered floor below, and a sun."""
    v, u = (np.mgrid[0:rows, 0:columns] + 0.5) / [[[rows]], [[columns]]]
    x = np.sin(np.pi * v) * np.sin(2 * np.pi * u)
    y, z = np.cos(np.pi * v), -np.sin(np.pi * v) * np.cos(2 * np.pi * u)
    sun = 200 * np.exp(600 * (-0.48 * x + 0.6 * y + 0.64 * z - 1))
    below = np.where(y < -0.05, y, -0.05)
    squares = (np.floor(x / below) + np.floor(z / below)) % 2
    fade = np.clip(-4 * y, 0, 1)
    ground = 0.25 + 0.2 * fade * (squares - 0.5)
    horizon = 1 - np.sqrt(np.clip(y, 0, 1))
    blue = np.stack([0.25 + 0.5 * horizon, 0.4 + 0.4 * horizon, 0.8 + 0 * y], axis=-1)
    pixels = np.where((y > 0)[..., None], blue, ground[..., None] * [1.0, 0.9, 0.8])
    return pixels + sun[..., None] * [1.0, 0.95, 0.8]


def in_a_probe(resolution):
    """Perfect mirror, gold, glass, and a rough sphere."""
    metal = optics.conductor("Au", 0.1)
    gold = Mirror(eta=np.asarray(metal.eta), k=np.asarray(metal.k))
    spheres = [
        Sphere([-1.8, 0, 0], 0.8, material=Mirror()),
        Sphere([0, 0, 0], 0.8, material=gold),
        Sphere([1.8, 0, 0], 0.8, material=Glass(1.5)),
        Sphere([0, -1.0, 1.2], 0.4),
    ]
    camera = Perspective([resolution * 9 // 16, resolution], position=[0, 0.5, 7])
    return Scene(camera, spheres, (Environment(sky()),))


def quad(*corners):
    """Two triangles."""
    return np.array(corners, float), np.array([[0, 1, 2], [0, 2, 3]])


def block(corners, height):
    """The twelve triangles of an upright block."""
    low = np.array([[x, 0, z] for x, z in corners], float)
    vertices = np.concatenate([low, low + [0, height, 0]])
    sides = [[i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4] for i in range(4)]
    faces = [*sides, [4, 5, 6, 7], [3, 2, 1, 0]]
    return vertices, np.array(
        [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    )


def cornell(resolution, ambient=0.0, mirror=False):
    """The box of C. Goral et al., SIGGRAPH 1984, as Cornell has measured it, in m.

    The light is a point below the white patch in the ceiling.
    """
    white, red, green = (
        Lambert(albedo=c) for c in ([0.74] * 3, [0.57, 0.04, 0.04], [0.1, 0.37, 0.07])
    )
    w, h, d = 552.8, 548.8, 559.2
    walls = [
        (quad([w, 0, 0], [0, 0, 0], [0, 0, d], [w, 0, d]), white),
        (quad([w, h, 0], [w, h, d], [0, h, d], [0, h, 0]), white),
        (quad([w, 0, d], [0, 0, d], [0, h, d], [w, h, d]), white),
        (quad([0, 0, d], [0, 0, 0], [0, h, 0], [0, h, d]), green),
        (quad([w, 0, 0], [w, 0, d], [w, h, d], [w, h, 0]), red),
        (
            quad(
                *(
                    [x, h - 0.1, z]
                    for x, z in ((343, 227), (343, 332), (213, 332), (213, 227))
                )
            ),
            white,
        ),
        (block([(130, 65), (82, 225), (240, 272), (290, 114)], 165), white),
        (
            block([(423, 247), (265, 296), (314, 456), (472, 406)], 330),
            Mirror() if mirror else white,
        ),
    ]
    shapes = [Mesh(mesh, scale=0.01, material=material) for mesh, material in walls]
    camera = Perspective(
        resolution,
        position=[2.78, 2.73, -8.0],
        target=[2.78, 2.73, 0],
        field_of_view=39.3,
    )
    lights = [Point([2.78, 5.2, 2.795], [26.0, 22.0, 15.0])]
    if ambient:
        lights.append(Ambient([ambient] * 3))
    return Scene(camera, shapes, lights, depth=3)


def table_top(resolution):
    """Matt, mirror and glass on a floor, lit from the side."""
    shapes = [
        Sphere([-1.15, -0.2, 0], 0.8),
        Sphere([0.9, -0.2, -0.6], 0.8, material=Mirror()),
        Sphere([0.2, -0.6, 1.4], 0.4, material=Glass(1.5)),
        Plane([0, -1, 0], material=GREY),
    ]
    lights = (Directional([0.64, 0.6, 0.48], 2.5), Ambient([0.15] * 3))
    camera = Perspective(resolution, position=[0, 1.2, 5.5], target=[0, -0.35, 0])
    return Scene(camera, shapes, lights)


def bumpy(resolution, height):
    """A sphere with waves of this height, and some light on its dark side."""
    v, u = (np.mgrid[0:256, 0:512] + 0.5) / [[[256]], [[512]]]
    waves = np.sin(40 * np.pi * u) * np.sin(20 * np.pi * v) * np.sin(np.pi * v)
    lumps = HeightMap(waves, scale=height) if height else None
    lights = (SUN, Ambient([0.3] * 3))
    return Scene(Orthographic(resolution), (Sphere(height=lumps),), lights)


def drawn(resolution, style):
    """A ring and a ball before a wall, in a style or none."""
    ring = trimesh.creation.torus(1.0, 0.35, 64, 24)
    turned = ring.vertices @ np.array([[1, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]])
    wall = Plane([0, 0, -2], [0, 0, 1], material=Lambert(albedo=[0.9] * 3))
    shapes = (Mesh((turned, ring.faces), smooth=True), Sphere(radius=0.45), wall)
    camera = Orthographic(resolution, height=3.0)
    return Scene(camera, shapes, (SUN,), style=style)


def timed(view, brdf, record, name, **options):
    """A picture, and a row for the table."""
    begin = time.perf_counter()
    made = plan(view, brdf, **options)
    planned = time.perf_counter() - begin
    render(brdf, view, made)
    seconds = []
    for _ in range(TURNS):
        begin = time.perf_counter()
        image = render(brdf, view, made)
        seconds.append(time.perf_counter() - begin)
    rows, columns = view.camera.shape
    record.append(
        {
            "picture": name,
            "pixels": f"{columns} x {rows}",
            "effects": " ".join(effect for effect in made.decisions if made.on(effect)),
            "directions": made.directions or "",
            "plan_seconds": planned,
            "seconds": statistics.median(seconds),
        }
    )
    return image


@styled
def row_of(pictures, title, exposure, width=2.4, grid=None):
    """Pictures beside each other, each with its name."""
    rows, columns = grid or (1, len(pictures))
    image = next(iter(pictures.values()))
    tall = width * image.shape[0] / image.shape[1] + 0.2
    figure = new_figure(width * columns, tall * rows + 0.3)
    panels = np.atleast_1d(figure.subplots(rows, columns)).flat
    for axes, (name, picture) in zip(panels, pictures.items(), strict=True):
        plot_sphere(axes, picture, exposure)
        axes.set_title(name)
    entitle(figure, title)
    return figure


def main(folder=RESULTS / "classic_scenes", resolution=RESOLUTION):
    """Write the table and five figures."""
    record, rows = Record(folder), []

    def seconds(name):
        return next(row["seconds"] for row in rows if row["picture"] == name)

    def took(name):
        return f"{name}, {1000 * rows[-1]['seconds']:.0f} ms"

    image = timed(
        in_a_probe(2 * resolution),
        BLUE,
        rows,
        "mirror and glass in a probe",
        tolerance=0.02,
    )
    title = "A mirror, gold and glass show each other, a rough sphere and the probe"
    record.figure(row_of({took("Whitted, depth 6"): image}, title, 0.8, 6.4), "probe")

    boxes = {}
    for name, view, options in (
        ("no shadows", cornell(resolution), {"without": ["shadows"]}),
        ("shadows", cornell(resolution), {}),
        ("shadows, ambient", cornell(resolution, 0.12), {}),
        ("and a mirror", cornell(resolution, 0.12, True), {}),
    ):
        image = timed(view, GREY, rows, f"Cornell box: {name}", **options)
        boxes[took(name)] = image
    both = (seconds(f"Cornell box: {name}") for name in ("shadows", "no shadows"))
    title = (
        "A Cornell box of 36 triangles under a point light takes "
        f"{operator.truediv(*both):.1f} times as long with shadows"
    )
    record.figure(row_of(boxes, title, 0.8), "cornell")

    pictures, view = {}, table_top(resolution)
    for name, without in (
        ("local shading", ["shadows", "bounces"]),
        ("with shadows", ["bounces"]),
        ("traced", []),
    ):
        image = timed(view, BLUE, rows, f"table top: {name}", without=without)
        pictures[took(name)] = image
    title = "What mirror and glass show must be traced: local shading leaves them black"
    record.figure(row_of(pictures, title, 0.9), "local")

    pictures = {}
    for height in HEIGHTS:
        view = bumpy(resolution, height)
        pictures[f"height {height:g} of the radius"] = timed(
            view, BLUE, rows, f"bumps of {height:g}"
        )
    title = "Bumps turn the normal and move no point: the outline stays round"
    record.figure(row_of(pictures, title, 1.0, 1.8), "bumps")

    pictures = {}
    for name, style in (
        ("light and shade", None),
        ("cool to warm", Gooch(outlines=False)),
        ("outlines", Gooch()),
        ("highlight", Gooch(highlight=0.8)),
        ("2 steps", Gooch(steps=2)),
        ("4 steps", Gooch(steps=4)),
        ("8 steps", Gooch(steps=8)),
        ("no colour of the material", Gooch(cool_diffuse=0, warm_diffuse=0)),
    ):
        view = drawn(resolution, style)
        pictures[name] = timed(view, BLUE, rows, f"Gooch: {name}")
    title = "Gooch's tones show the shape that light and shade leave black"
    record.figure(row_of(pictures, title, 1.0, 2.0, (2, 4)), "gooch")

    record.table(rows)
    slowest = max(rows, key=lambda row: row["seconds"])
    record.close(
        finding=f"{len(rows)} pictures in {sum(row['seconds'] for row in rows):.1f} s, "
        f"{slowest['picture']} the slowest in {slowest['seconds']:.1f} s.",
        resolution=resolution,
    )


if __name__ == "__main__":
    main()
