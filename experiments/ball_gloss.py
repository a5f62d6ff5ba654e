"""How many lobes does the gloss of a photographed ball take?

Twelve linear photographs of one ball, each under one distant light, are fitted with a
diffuse base alone, with one and with two GGX lobes beside it. A second lobe beside
Lambert's base is spent on the base: the ball grows darker towards its rim than Lambert
allows. The base under a coat, `plastic_ggx`, does so, and brings the first of its two
lobes, a broad one; the second is the sharp gloss. What no lobe can do is told by two
references that are no models: any function at all of the angle between half vector and
normal, common to all photographs, and one for each photograph about its own centre of
the highlight. The first is what the two lobes reach; the second is what the lights
leave, whose mirror images are not round and lie up to half a pixel aside. The error of
an image is the root mean square of fitted minus photographed values over that of the
photograph; in the highlight, where a photograph exceeds twice what the base alone
shows, it is told by itself, and so in the halo about it, where the half vector is 2 to
15 degrees from the normal. The pictures show fits and differences only, because the
photographs may not be given away.

It needs the folder `sphere_photos/diligent_ball` of the data folder that `BRDFFIT_DATA`
names.
"""

import sys

import numpy as np
from scipy.optimize import minimize

import brdffit
from brdffit.fit.appearance import sphere_difference
from brdffit.plots.spheres import plot_difference, plot_sphere
from brdffit.plots.style import entitle, new_figure, spread
from brdffit.render.shading import compiled_shade
from experiments import captions
from experiments.merl_standins import DATA
from experiments.record import RESULTS, Record, styled

FOLDER = DATA / "sphere_photos" / "diligent_ball"
MODELS = {
    "lambert": "base alone",
    "ggx": "one lobe",
    "ggx+ggx_lobe": "two lobes",
    "plastic_ggx+ggx_lobe": "two lobes, base under a coat",
}
STARTS = 8
FRAMES = 2  # shown, of twelve
LIMIT = 0.008  # end of the colours of differences
CELLS = (
    *np.arange(0.5, 3, 0.25),
    *(3, 3.5, 4, 5, 6, 7, 8, 10, 12),
    *range(15, 90, 5),
)  # degrees from half vector to normal
HALO = (2.0, 15.0)
GLOSSY = 2.0  # times the base alone, beyond which a pixel is in the highlight


def error(found, wanted):
    """Root mean square of the difference over that of what is wanted."""
    return float(np.sqrt(np.mean((found - wanted) ** 2) / np.mean(wanted**2)))


def tilts(data):
    """Half vectors ``(N, 3)``, and their angles to the normal in degrees."""
    half = np.asarray(data.wi)[:, 0] + np.asarray(data.wo)
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    return half, np.degrees(np.arccos(np.clip(half[:, 2], -1, 1)))


def any_function(tilt, data):
    """The nearest to the photographs that is a function of the tilt alone."""
    cell = np.digitize(tilt, CELLS)
    weight, value = np.asarray(data.weight)[:, 0], np.asarray(data.value)
    shown = np.empty_like(value)
    for channel in range(value.shape[1]):
        w, v = weight[:, channel], value[:, channel]
        sums = [np.bincount(cell, x, len(CELLS) + 1) for x in (v * w, w * w)]
        shown[:, channel] = w * (sums[0] / np.maximum(sums[1], 1e-30))[cell]
    return shown


def centred(data):
    """The tilt about the normal that fits a highlight best, and how far that is off."""
    half, tilt = tilts(data)
    near = tilt < HALO[1]
    close = data.take(near)

    def about(aside):
        up = np.array([*aside, np.sqrt(1 - np.dot(aside, aside))])
        return np.degrees(np.arccos(np.clip(half @ up, -1, 1)))

    def cost(aside):
        return np.sum((any_function(about(aside)[near], close) - close.value) ** 2)

    found = [
        minimize(cost, start, method="Nelder-Mead", options={"initial_simplex": around})
        for start in np.radians([[0.4, 0.4], [0.4, -0.4], [-0.4, 0.4], [-0.4, -0.4]])
        for around in [start + np.radians([[0, 0], [0.5, 0], [0, 0.5]])]
    ]
    best = min(found, key=lambda result: result.fun).x
    return about(best), float(np.degrees(np.linalg.norm(best)))


def references(data):
    """What functions of the tilt alone can show, and how far highlights are off."""
    _, tilt = tilts(data)
    frame, shown, aside = np.asarray(data.pixels.frame), np.empty_like(data.value), []
    for place in range(data.pixels.shape[0]):
        here = frame == place
        moved, off = centred(data.take(here))
        shown[here] = any_function(moved, data.take(here))
        aside.append(off)
    return {
        "(any function of theta_h)": any_function(tilt, data),
        "(one for each photograph)": shown,
    }, aside


def rows_of(data, fits, shown):
    """A row for each model, and for each reference."""
    use = np.asarray(data.mask).all(axis=1)
    data = data.take(use)
    wanted, tilt = np.asarray(data.value), tilts(data)[1]
    shown = {
        n: np.asarray(compiled_shade(f.brdf, data)) for n, f in fits.items()
    } | shown
    bright = wanted.mean(axis=1) > GLOSSY * shown["lambert"].mean(axis=1)
    halo = (tilt > HALO[0]) & (tilt < HALO[1]) & ~bright
    for name, found in shown.items():
        fit = fits.get(name)
        colours = fit and sphere_difference(fit.brdf, data)
        yield {
            "model": name,
            "image_error_percent": 100 * error(found, wanted),
            "in_highlight_percent": 100 * error(found[bright], wanted[bright]),
            "in_halo_percent": 100 * error(found[halo], wanted[halo]),
            "elsewhere_percent": 100 * error(found[~bright], wanted[~bright]),
            "ciede2000": colours.ciede2000 if colours else "",
            "delta_e_itp": colours.itp if colours else "",
            "parameters": "; ".join(
                f"{n} {' '.join(f'{x:.3g}' for x in np.ravel(v))}"
                for n, v in (fit.parameters if fit else {}).items()
            ),
        }


@styled
def pictures(data, fits, title):
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
            above.set_title(f"{MODELS[name]}, light {frame + 1}", size=8)
            image = plot_difference(below, cut(data, difference, frame), LIMIT)
    bar = figure.colorbar(image, ax=grid, extend="both", shrink=0.5, aspect=30)
    bar.set_label("fitted - photographed, mean of the channels")
    entitle(figure, title)
    figure.supxlabel(
        "Balls as fitted, and below them fitted minus photographed", size=8
    )
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
    shown, aside = references(data.take(np.asarray(data.mask).all(axis=1)))
    record.table(list(rows_of(data, fits, shown)))
    record.figure(pictures(data, fits, captions.ball_gloss(record.folder)))
    record.close(
        starts=starts,
        models=MODELS,
        centres_aside_degrees=[round(off, 2) for off in aside],
    )


if __name__ == "__main__":
    main()
