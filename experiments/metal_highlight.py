"""How does the highlight of a metal end, with Beckmann's and with GGX facets?

Gold under one light. Beckmann is shown twice: with the alpha of GGX, and with the
smaller one that makes the highlight fall to half at the same angle.
"""

import jax
import jax.numpy as jnp
import numpy as np

from brdffit import optics
from brdffit.geometry import direction
from brdffit.models import ConductorBeckmann
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import COLOURS, DASHES, new_figure
from brdffit.render import render
from brdffit.scene import lit_sphere
from experiments.record import RESULTS, Record, styled

METAL = "Au"
ALPHAS = (0.1, 0.3)
INCIDENCE = 30.0  # deg
ANGLES = np.linspace(-119, 59, 1781)  # deg from the mirror direction, away from normal
TIMES = (2, 3, 4)  # half-widths from the peak
LIGHT = (-0.36, 0.48, 0.8)
RESOLUTION = 192
EXPOSURE = 4  # times white is the brightest pixel of each sphere
LABELS = ("GGX", "Beckmann, same alpha", "Beckmann, same half-width")
SAME_WIDTH = np.sqrt((np.sqrt(2) - 1) / np.log(2))  # of alphas, to first order


def models(alpha):
    """Gold with GGX facets, and with Beckmann's as rough and as wide."""
    ggx = optics.conductor(METAL, alpha)
    index = {"eta": ggx.eta, "k": ggx.k}
    return {
        f"conductor_ggx, alpha {alpha:g}": ggx,
        f"conductor_beckmann, alpha {alpha:g}": ConductorBeckmann(alpha=alpha, **index),
        f"conductor_beckmann, alpha {alpha * SAME_WIDTH:.3g}": ConductorBeckmann(
            alpha=alpha * SAME_WIDTH, **index
        ),
    }


@jax.jit
def _profile(brdf, wi, wo):
    return jnp.mean(jax.vmap(brdf, (None, 0))(wi, wo), axis=1)


def profile(brdf):
    """Mean of the channels in the plane of incidence at `ANGLES`, over the largest."""
    theta = jnp.radians(jnp.asarray(INCIDENCE + ANGLES))
    wi = direction(jnp.radians(INCIDENCE), jnp.asarray(np.pi))
    wo = jax.vmap(direction)(theta, jnp.zeros_like(theta))
    f_r = np.asarray(_profile(brdf, wi, wo), float)
    return f_r / f_r.max()


def half_width(lobe):
    """Angle between the peak and half of it, on the side of the normal, in degrees."""
    peak = int(np.argmax(lobe))
    below = peak - int(np.argmax(lobe[:peak][::-1] < 0.5))
    return float(ANGLES[peak] - ANGLES[below])


def facts(lobes):
    """One row for each lobe: its width and its tail."""
    rows = []
    for name, lobe in lobes.items():
        peak, width = ANGLES[np.argmax(lobe)], half_width(lobe)
        tail = np.interp([peak - n * width for n in TIMES], ANGLES, lobe)
        row = {"model": name, "half_width_deg": width}
        rows.append(
            row | {f"at_{n}_widths": float(x) for n, x in zip(TIMES, tail, strict=True)}
        )
    return rows


@styled
def chart(groups, tables):
    """Lobes above, spheres below."""
    figure = new_figure(9.4, 6.4)
    above, below = figure.subfigures(2, 1, height_ratios=(2, 1))
    panels = above.subplots(1, len(ALPHAS), sharey=True)
    for axes, (alpha, lobes), rows in zip(panels, groups.items(), tables, strict=True):
        for n, lobe in enumerate(lobes.values()):
            look = {"color": COLOURS[n], "linestyle": DASHES[n]}
            axes.plot(ANGLES, lobe, label=LABELS[n], **look)
        ratio = rows[0]["at_3_widths"] / rows[2]["at_3_widths"]
        axes.set_title(
            f"alpha {alpha:g}: three half-widths from the peak GGX\n"
            f"is {ratio:,.0f} times as bright as Beckmann of its width"
        )
        axes.set(yscale="log", ylim=(1e-5, 2), xlim=(-100, 60))
        axes.set_xlabel("angle from the mirror direction, away from the normal (deg)")
    panels[0].set_ylabel("$f_r$ / its largest value, mean of RGB, log scale")
    above.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3
    )
    scene = lit_sphere(RESOLUTION, [LIGHT], np.pi)
    shown = [item for alpha in ALPHAS for item in models(alpha).items()]
    for axes, (name, brdf) in zip(below.subplots(1, 6), shown, strict=True):
        image = render(brdf, scene)
        image[~inside(image)] = np.nan
        plot_sphere(axes, image, EXPOSURE / float(np.nanmax(image)))
        axes.set_title(name.replace("conductor_", "").replace(", ", "\n"), size=8)
    below.supxlabel(
        "Spheres under one light from the upper left, sRGB, each with its brightest "
        f"pixel at {EXPOSURE} times white",
        size=8,
    )
    figure.suptitle(
        f"{METAL}: a highlight of GGX ends in a glow, one of Beckmann in black "
        f"(curves: light at {INCIDENCE:g} degrees)"
    )
    return figure


def inside(image):
    """Pixels of the sphere."""
    centre = (2 * np.arange(len(image)) + 1) / len(image) - 1
    return centre[:, None] ** 2 + centre**2 < 1


def main(folder=RESULTS / "metal_highlight"):
    """Write table and figure."""
    record = Record(folder)
    groups = {
        alpha: {name: profile(brdf) for name, brdf in models(alpha).items()}
        for alpha in ALPHAS
    }
    tables = [facts(lobes) for lobes in groups.values()]
    record.table([row for rows in tables for row in rows])
    record.figure(chart(groups, tables))
    ggx, _, beckmann, *_ = tables[0]
    ratio = ggx["at_3_widths"] / beckmann["at_3_widths"]
    record.close(
        finding=f"Three half widths from the peak, GGX is {ratio:.0f} times as bright "
        "as Beckmann with a highlight as wide.",
        metal=METAL,
        incidence_deg=INCIDENCE,
    )


if __name__ == "__main__":
    main()
