"""How many lobes does the gloss of a photographed ball take?

Twelve linear photographs of one ball, each under one distant light, are fitted with a
diffuse base alone, with one and with two GGX lobes beside it, under the
cosine-weighted residual. The error of an image is the root mean square of fitted minus
photographed values over that of the photograph; in the highlight, where a photograph
exceeds what the base alone could show, it is told by itself. The pictures show fits and
differences only, because the photographs may not be given away.

It needs the folder `sphere_photos/diligent_ball` of the data folder that `BRDFFIT_DATA`
names.
"""

import sys

import numpy as np

import brdffit
from brdffit.fit.appearance import sphere_difference
from brdffit.plots.spheres import plot_difference, plot_sphere
from brdffit.plots.style import new_figure, spread
from brdffit.render.shading import compiled_shade
from experiments.merl_standins import DATA
from experiments.record import RESULTS, Record, styled

FOLDER = DATA / "sphere_photos" / "diligent_ball"
MODELS = {
    "lambert": "base alone",
    "ggx": "one lobe",
    "ggx+ggx_lobe": "two lobes",
}
STARTS = 8
FRAMES = 2  # shown, of twelve
LIMIT = 0.008  # end of the colours of differences
GLOSSY = 2.0  # times the base alone, beyond which a pixel is in the highlight


def error(found, wanted):
    """Root mean square of the difference over that of what is wanted."""
    return float(np.sqrt(np.mean((found - wanted) ** 2) / np.mean(wanted**2)))


def rows_of(data, fits):
    """A row for each model."""
    use = np.asarray(data.mask).all(axis=1)
    wanted = np.asarray(data.value)[use]
    shown = {
        name: np.asarray(compiled_shade(fit.brdf, data))[use]
        for name, fit in fits.items()
    }
    bright = wanted.mean(axis=1) > GLOSSY * shown["lambert"].mean(axis=1)
    for name, fit in fits.items():
        colours = sphere_difference(fit.brdf, data)
        yield {
            "model": name,
            "image_error_percent": 100 * error(shown[name], wanted),
            "in_highlight_percent": 100 * error(shown[name][bright], wanted[bright]),
            "elsewhere_percent": 100 * error(shown[name][~bright], wanted[~bright]),
            "ciede2000": colours.ciede2000,
            "delta_e_itp": colours.itp,
            "share_in_highlight_percent": 100 * float(bright.mean()),
            "parameters": "; ".join(
                f"{n} {' '.join(f'{x:.3g}' for x in np.ravel(v))}"
                for n, v in fit.parameters.items()
            ),
        }


@styled
def pictures(data, fits):
    """Fitted spheres above, and what they differ by from the photographs below."""
    frames = spread(range(data.pixels.shape[0]), FRAMES)
    figure = new_figure(0.9 + 1.9 * len(fits), 0.5 + 3.8 * len(frames))
    grid = figure.subplots(2 * len(frames), len(fits), squeeze=False)
    value, used = np.asarray(data.value), np.asarray(data.mask).all(axis=1)
    for row, frame in enumerate(frames):
        here = np.asarray(data.pixels.frame) == frame
        exposure = 0.8 / float(np.percentile(value[here & used], 99))
        for above, below, (name, fit) in zip(
            grid[2 * row], grid[2 * row + 1], fits.items(), strict=True
        ):
            shown = np.asarray(compiled_shade(fit.brdf, data.take(here)))
            difference = np.full(value.shape, np.nan)
            difference[here] = np.where(used[here, None], shown - value[here], np.nan)
            whole = np.full(value.shape, np.nan)
            whole[here] = shown
            plot_sphere(above, cut(data, whole, frame), exposure)
            above.set_title(f"{name}, light {frame + 1}")
            image = plot_difference(below, cut(data, difference, frame), LIMIT)
    bar = figure.colorbar(image, ax=grid, extend="both", shrink=0.5)
    bar.set_label("fitted - photographed, mean of the channels")
    figure.suptitle("Fitted balls, and their differences from photographs")
    return figure


def cut(data, values, frame):
    """One frame, cut to the rows and columns of the ball."""
    where = data.pixels
    image = where.images(values.astype(np.float32))[frame]
    return image[
        where.row.min() : where.row.max() + 1,
        where.column.min() : where.column.max() + 1,
    ]


def main(folder=RESULTS / "ball_gloss", models=tuple(MODELS), starts=STARTS):
    """Write the table and the pictures."""
    if not FOLDER.is_dir():
        sys.exit(f"Folder `{FOLDER}` must exist: set BRDFFIT_DATA.")
    brdffit.enable_compilation_cache()
    record, data = Record(folder), brdffit.load(FOLDER)
    fits = {name: brdffit.fit(name, data, starts=starts) for name in models}
    record.table(list(rows_of(data, fits)))
    record.figure(pictures(data, fits))
    record.close(starts=starts, models=MODELS)


if __name__ == "__main__":
    main()
