"""How does a sphere of each model look?

Every model of the catalogue on a sphere under one light from the upper left and two
behind it, copper-coloured where a model has a colour, everything else at its default;
the exposure of each picture shows its brightest percent at white. The table of models
in the README is made of the same pictures.
"""

import inspect

import jax.numpy as jnp
import numpy as np
from PIL import Image

from benchmarks.problems import LIGHTS
from brdffit import images, lit_sphere, render
from brdffit.models import MODELS
from brdffit.parameters import parameters
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import new_figure
from experiments.record import RESULTS, Record, styled

RESOLUTION = 160
SMALL = 72  # pixels of a picture in a table
COPPER = (0.75, 0.36, 0.2)
GREY = 0.25  # of gloss on a coloured base
INDEX = {"eta": (0.28, 0.85, 1.3), "k": (3.4, 2.6, 2.4)}  # of copper, about
BASES = ("albedo", "diffuse", "base")
SKIPPED = ("sum",)


def coloured(name):
    """A model with a coloured base, or coloured gloss where it has no base."""
    model, chosen = MODELS[name](), {}
    spectral = [n for n, known in parameters(model).items() if known.spectral]
    has_base = any(base in spectral for base in BASES)
    for parameter in spectral:
        if parameter in INDEX:
            chosen[parameter] = INDEX[parameter]
        elif parameter in BASES:
            dark = 0.3 if parameter == "diffuse" and "k" in spectral else 1.0
            chosen[parameter] = tuple(dark * x for x in COPPER)
        elif "k" in spectral:
            chosen[parameter] = (1.0,) * 3
        else:
            chosen[parameter] = (GREY,) * 3 if has_base else COPPER
    if name == "ggx_multiscatter":
        chosen |= {"diffuse": (0.0,) * 3, "f0": COPPER}
    if "wavelengths" in inspect.signature(MODELS[name]).parameters:
        chosen["wavelengths"] = (0.61, 0.55, 0.465)
    return MODELS[name](**{n: jnp.asarray(v) for n, v in chosen.items()})


def pictures(names, resolution):
    """Linear image of each model with its exposure."""
    scene, found = lit_sphere(resolution, LIGHTS), {}
    for name in names:
        image = render(coloured(name), scene)
        seen = image[image > 0]
        found[name] = image, 0.9 / float(np.percentile(seen, 99))
    return found


@styled
def sheet(found):
    """All models on one sheet."""
    columns = 7
    lines = -(-len(found) // columns)
    figure = new_figure(1.45 * columns, 1.7 * lines + 0.5)
    panels = figure.subplots(lines, columns, squeeze=False).ravel()
    for axes in panels[len(found) :]:
        axes.set_axis_off()
    for axes, (name, (image, exposure)) in zip(panels, found.items(), strict=False):
        plot_sphere(axes, image, exposure)
        axes.set_title(name, size=7.5)
    figure.suptitle(f"{len(found)} models of the catalogue under three lights")
    return figure


def small(image, exposure):
    """A picture for a table, transparent beside the sphere."""
    shown = images.preview(np.nan_to_num(image), exposure)
    rows, columns = np.mgrid[0 : len(shown), 0 : len(shown)] + 0.5
    middle = len(shown) / 2
    inside = np.hypot(rows - middle, columns - middle) < middle
    layers = np.dstack([shown, np.where(inside, 255, 0)]).astype(np.uint8)
    return Image.fromarray(layers, "RGBA").resize((SMALL, SMALL), Image.LANCZOS)


def main(folder=RESULTS / "catalogue", names=None, resolution=RESOLUTION):
    """Write the sheet, a small picture of each model, and a table."""
    record = Record(folder)
    names = names or [name for name in MODELS if name not in SKIPPED]
    found = pictures(names, resolution)
    for name, (image, exposure) in found.items():
        record.picture(small(image, exposure), name)
    record.figure(sheet(found))
    record.table(
        [
            {
                "model": name,
                "mean_radiance": float(np.mean(image)),
                "brightest": float(np.max(image)),
                "exposure": exposure,
            }
            for name, (image, exposure) in found.items()
        ]
    )
    record.close(
        finding=f"{len(found)} models, each in one file, by one call of `render`.",
        resolution=resolution,
    )


if __name__ == "__main__":
    main()
