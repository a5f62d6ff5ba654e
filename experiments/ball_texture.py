"""What do twelve photographs of a ball tell about each texel?

Each photograph is held out in turn. The others give each texel eleven observations, to
which a model is fitted in four ways: the whole ball as one material; the diffuse base
of each texel alone; everything of each texel; and the gloss of the one material with a
diffuse base for each texel. Then the photograph that was held out is predicted. Its
error is the root mean square of predicted minus photographed values over that of the
photograph; in the highlight, where the reflectance exceeds twice its median, it is told
by itself. The pictures show fits, predictions and differences only, because the
photographs may not be given away.

It needs the folder `sphere_photos/diligent_ball` of the data folder that `BRDFFIT_DATA`
names.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import brdffit
from brdffit.batch.relighting import held_out
from brdffit.batch.surface import open_surface
from brdffit.catalogue import from_name
from brdffit.fit.texture import fit_texels
from brdffit.parameters import parameters
from brdffit.plots.maps import plot_colours, plot_map, window
from brdffit.plots.spheres import plot_difference, plot_sphere
from brdffit.plots.style import entitle, new_figure
from brdffit.render import shade_texels
from experiments.ball_gloss import FOLDER
from experiments.record import RESULTS, Record, styled

ONE, OWN, MIXED = "one material", "each texel", "each texel, gloss of the whole"
WAYS = (
    ("lambert", OWN),
    ("ggx", ONE),
    ("ggx", OWN),
    ("ggx", MIXED),
    ("ggx+ggx_lobe", MIXED),
)
STARTS = 8
GLOSSY = 2.0  # times the median reflectance, beyond which a pixel is in the highlight
SHOWN = "041.png"
LIMIT = 0.004  # end of the colours of differences


def fitted(model, way, whole, texels):
    """Parameters ``(channel or 1, texel)`` of all texels, and the fit of each."""
    one = {}
    if way != OWN:
        result = brdffit.fit(model, whole, starts=STARTS)
        one = {name: np.asarray(value) for name, value in result.parameters.items()}
    if way == ONE:
        wide = {name: np.atleast_1d(value)[:, None] for name, value in one.items()}
        return {n: np.repeat(v, len(texels), axis=1) for n, v in wide.items()}, None
    held = {name: v for name, v in one.items() if not name.endswith("diffuse")}
    fits = fit_texels(model, texels, fixed=held)
    return fits.parameters, fits


def predictions(surface, data, numbers, ways):
    """For each way and photograph: what was predicted, and the fits."""
    count = len(surface.photographs)
    frame = np.asarray(data.pixels.frame)
    for number in numbers:
        rest, other = held_out(surface.stack, count, number)
        texels = rest.read(0, surface.stack.texels)
        seen = other.read(0, surface.stack.texels)
        whole = data.take(frame != number)
        for model, way in ways:
            values, fits = fitted(model, way, whole, texels)
            brdf = from_name(model, len(surface.channels))
            light = seen.wi, seen.wo, seen.weight
            shown = np.asarray(shade_texels(brdf, values, *light))[0]
            yield number, (model, way), seen, shown, fits


def in_highlight(seen):
    """Where ``(texel,)`` a photograph shows the gloss."""
    used = seen.mask[0].all(axis=0)
    weight = np.where(used, seen.weight[0], 1)
    reflectance = np.where(used, seen.value[0] / weight, 0).mean(axis=0)
    return used & (reflectance > GLOSSY * np.median(reflectance[used]))


def squares(seen, shown):
    """Sums of squares of error and of photograph: highlight, elsewhere."""
    used = seen.mask[0].all(axis=0)
    bright = in_highlight(seen)
    for here in (bright, used & ~bright):
        wanted = seen.value[0][:, here].astype(float)
        yield np.sum((shown[:, here] - wanted) ** 2), np.sum(wanted**2)


def rows_of(found):
    """A row for each way, over all photographs."""
    for model, way in dict.fromkeys(key for _, key, *_ in found):
        mine = [entry for entry in found if entry[1] == (model, way)]
        sums = np.array([list(squares(seen, shown)) for _, _, seen, shown, _ in mine])
        each = np.sqrt(sums[..., 0].sum(axis=1) / sums[..., 1].sum(axis=1))
        bright, dull = np.sqrt(sums[..., 0].sum(axis=0) / sums[..., 1].sum(axis=0))
        fits = [fit for *_, fit in mine if fit is not None]
        known = [
            np.mean(
                [np.isfinite(fit.standard_errors[name]).all(axis=0) for fit in fits]
            )
            for name in parameters(from_name(model))
            if fits and way == OWN
        ]
        yield {
            "model": model,
            "fitted": way,
            "error_percent": 100
            * float(np.sqrt(sums[..., 0].sum() / sums[..., 1].sum())),
            "best_light_percent": 100 * float(each.min()),
            "worst_light_percent": 100 * float(each.max()),
            "in_highlight_percent": 100 * float(bright),
            "elsewhere_percent": 100 * float(dull),
            "converged_percent": 100 * float(np.mean([f.converged for f in fits]))
            if fits
            else "",
            "determined_percent": " ".join(f"{100 * x:.1f}" for x in known),
        }


@styled
def pictures(surface, found, title):
    """Maps above; below, one photograph predicted and missed."""
    shown_number = surface.photographs.index(SHOWN)
    here = {key: entry for n, key, *entry in found if n == shown_number}
    layout = surface.layout
    (_, _, own), (seen, shown, mixed) = here["ggx", OWN], here["ggx", MIXED]
    where = window(layout.image(shown), 512)

    def cut(values):
        return layout.image(values)[where]

    figure = new_figure(10.2, 6.4)
    (a, b, c), (d, e, f) = figure.subplots(2, 3)
    plot_colours(
        a, cut(mixed.parameters["diffuse"]), "diffuse base of each texel", "diffuse"
    )
    error = own.standard_errors["alpha"]
    alpha = np.where(np.isinf(error), np.inf, own.parameters["alpha"])
    plot_map(b, cut(alpha)[..., 0], "alpha of each texel", "alpha", True)
    plot_map(
        c, cut(mixed.rms[None])[..., 0], "residual of each texel", "root mean square"
    )
    exposure = 1 / float(np.nanpercentile(shown, 99.5))
    plot_sphere(d, cut(shown), exposure)
    d.set_title(f"predicted under the light of {SHOWN},\ngloss of the whole")
    for axes, (_, other, _), what in (
        (e, here["ggx", MIXED], "gloss of the whole"),
        (f, here["ggx", OWN], "gloss of each texel"),
    ):
        used = seen.mask[0]
        difference = cut(np.where(used, other - seen.value[0], np.nan))
        unused = cut((~used).astype(np.float32))
        image = plot_difference(axes, difference, LIMIT, np.nan_to_num(unused))
        bar = figure.colorbar(image, ax=axes, extend="both", fraction=0.05, pad=0.03)
        bar.set_label("radiance, mean of channels", size=8)
        missed, whole = np.sum(list(squares(seen, other)), axis=0)
        axes.set_title(
            f"predicted - photographed, {what}:\nrelative root mean square "
            f"{100 * np.sqrt(missed / whole):.1f} %"
        )
    entitle(figure, title)
    figure.supxlabel("below, grey: not compared, as no light falls there", size=8)
    return figure


def main(folder=RESULTS / "ball_texture", photographs=None, ways=WAYS):
    """Write the table and the pictures."""
    if not FOLDER.is_dir():
        sys.exit(f"Folder `{FOLDER}` must exist: set BRDFFIT_DATA.")
    brdffit.enable_compilation_cache()
    record, data = Record(folder), brdffit.load(FOLDER)
    with tempfile.TemporaryDirectory() as kept:
        surface = open_surface(FOLDER, Path(kept) / "stack.zarr")
        names = photographs or surface.photographs
        numbers = [surface.photographs.index(name) for name in names]
        found = list(predictions(surface, data, numbers, ways))
    rows = list(rows_of(found))
    record.table(rows)
    errors = {(row["model"], row["fitted"]): row["error_percent"] for row in rows}
    finding = (
        f"With the gloss of the whole ball and a base for each texel, held-out "
        f"photographs are predicted to {errors['ggx', MIXED]:.1f} %, against "
        f"{errors['ggx', ONE]:.1f} % with one material; eleven lights do not tell the "
        f"gloss of each texel, and what a fit makes up there is off by "
        f"{errors['ggx', OWN]:.0f} %."
    )
    record.figure(pictures(surface, found, finding))
    record.close(
        finding=finding,
        starts=STARTS,
        shown=SHOWN,
        texels=len(found[0][3][0]),
        photographs=len(names),
    )


if __name__ == "__main__":
    main()
