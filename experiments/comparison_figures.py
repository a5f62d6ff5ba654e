"""Figures of the comparison of three classic models."""

import numpy as np

from brdffit.plots.spheres import plot_difference, plot_sphere
from brdffit.plots.style import COLOURS, DASHES, DATA as BLACK, entitle, new_figure
from experiments.comparison_sets import modelled, sphere
from experiments.pareto import label_plainly
from experiments.record import styled

CLASSIC = ("phong", "cook_torrance", "oren_nayar")
RESIDUALS = ("cosine_weighted", "log", "cube_root", "log_relative")
SHOWN = "cube_root"  # residual of the spheres and lobes that are drawn
INCIDENCE = 45.0  # degrees, of lobes


def best(rows, key, **chosen):
    """The line with the least of something, among those that are chosen."""
    own = [r for r in rows if all(r[k] == v for k, v in chosen.items())]
    return min(own, key=lambda row: row[key])


@styled
def matrix(rows, words):
    """Colour difference of every model, material and residual, the winners marked."""
    names = list(dict.fromkeys(row["material"] for row in rows))
    figure = new_figure(10.0, 1.9 + 0.42 * len(names))
    panels = figure.subplots(1, len(CLASSIC), sharey=True)
    top = float(np.quantile([row["ciede2000"] for row in rows], 0.9))
    for axes, model in zip(panels, CLASSIC, strict=True):
        values = np.array(
            [
                [
                    best(rows, "rms", material=m, residual=r, model=model)["ciede2000"]
                    for r in RESIDUALS
                ]
                for m in names
            ]
        )
        shown = axes.imshow(values, cmap="cividis_r", vmin=0, vmax=top, aspect="auto")
        for y, material in enumerate(names):
            for x, residual in enumerate(RESIDUALS):
                won = best(rows, "rms", material=material, residual=residual)
                seen = best(rows, "ciede2000", material=material)
                text = f"{values[y, x]:.2g}"
                text += " ●" if won["model"] == model else ""
                pick = seen["model"] == model and seen["residual"] == residual
                text += " ★" if pick else ""
                dark = values[y, x] > 0.55 * top
                axes.text(
                    x,
                    y,
                    text,
                    ha="center",
                    va="center",
                    size=7,
                    color="white" if dark else "black",
                )
        axes.set_xticks(
            range(len(RESIDUALS)), [r.replace("_", "\n") for r in RESIDUALS]
        )
        axes.set_yticks(range(len(names)), names)
        axes.set(title=model, xlabel="residual that the fit minimised")
        axes.grid(visible=False)
    bar = figure.colorbar(shown, ax=panels, extend="max", pad=0.01)
    bar.set_label("CIEDE2000 of the sphere")
    figure.supxlabel(
        "● least error under the residual     ★ closest sphere of all twelve fits",
        size=8,
    )
    entitle(figure, words)
    return figure


@styled
def spheres(found, fitted, rows, resolution):
    """Measured sphere, three fits and their differences, a row for each material."""
    columns = 1 + 2 * len(CLASSIC)
    figure = new_figure(1.45 * columns, 1.62 * len(found) + 0.7)
    grid = figure.subplots(len(found), columns, squeeze=False)
    for line, (name, material) in zip(grid, found.items(), strict=True):
        wanted, values = sphere(material.f_r, resolution)
        exposure = 0.8 / float(np.percentile(values[values > 0], 99))
        plot_sphere(line[0], wanted, exposure)
        line[0].set_title(name.replace(" ", "\n", 1), size=8)
        for place, model in enumerate(CLASSIC):
            image, _ = sphere(modelled(fitted[name][SHOWN, model].brdf), resolution)
            plot_sphere(line[1 + 2 * place], image, exposure)
            row = best(rows, "rms", material=name, residual=SHOWN, model=model)
            line[1 + 2 * place].set_title(
                f"{model}\nCIEDE2000 {row['ciede2000']:.2g}", size=8
            )
            difference = exposure * (image - wanted)
            shown = plot_difference(line[2 + 2 * place], difference, 0.3)
            line[2 + 2 * place].set_title("difference", size=8)
    bar = figure.colorbar(shown, ax=grid, extend="both", shrink=0.4, pad=0.01)
    bar.set_label("fitted - material, as shown")
    winner = [
        best(rows, "ciede2000", material=name, residual=SHOWN)["model"]
        for name in found
    ]
    most = max(CLASSIC, key=winner.count)
    entitle(
        figure,
        f"Fitted under {SHOWN}, {most} gives the closest sphere on "
        f"{winner.count(most)} of {len(found)} materials",
    )
    return figure


@styled
def lobes(found, fitted):
    """Reflectance in the plane of incidence of each material and fit."""
    columns = 4
    lines = -(-len(found) // columns)
    figure = new_figure(2.6 * columns, 2.4 * lines + 0.8)
    panels = figure.subplots(lines, columns, squeeze=False, sharex=True).ravel()
    angle = np.linspace(-80, 80, 161)
    o, i = np.radians(angle), np.radians(INCIDENCE)
    wo = np.stack([np.sin(o), 0 * o, np.cos(o)], axis=1).astype(np.float32)
    wi = np.tile(np.array([-np.sin(i), 0, np.cos(i)], np.float32), (len(o), 1))
    for axes in panels[len(found) :]:
        axes.set_axis_off()
    closest = []
    for axes, (name, material) in zip(panels, found.items(), strict=False):
        off = {}
        green = np.asarray(material.f_r(wi, wo))[:, 1]
        axes.plot(
            angle, np.where(green > 0, green, np.nan), color=BLACK, label="material"
        )
        for model, colour, dash in zip(CLASSIC, COLOURS, DASHES[1:], strict=False):
            curve = modelled(fitted[name][SHOWN, model].brdf)(wi, wo)[:, 1]
            axes.plot(angle, curve, color=colour, ls=dash, label=model)
            lit = (green > 0) & (curve > 0)
            off[model] = np.sqrt(np.mean(np.log(curve[lit] / green[lit]) ** 2))
        closest.append(min(off, key=off.get))
        axes.set(yscale="log", title=name)
        label_plainly(axes.yaxis)
        axes.set_xlabel(r"$\theta_o$ [degrees]")
        axes.set_ylabel(r"$f_r$ [1/sr], log scale")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4
    )
    most = max(CLASSIC, key=closest.count)
    entitle(
        figure,
        f"{most} has the closest lobe on {closest.count(most)} of {len(found)} "
        f"materials: light from -{INCIDENCE:.0f} degrees, green channel, fitted under "
        f"{SHOWN}",
    )
    return figure
