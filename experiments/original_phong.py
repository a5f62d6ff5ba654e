"""When does the original Phong model give wrong results?

Three things are looked at, beside `phong`, `blinn_phong` and `ggx` whose highlight is
as wide at normal incidence: how much light comes back (more than came, towards
grazing), whether light and viewer may change places, and what happens where the lobe is
cut off, 90 degrees from the mirror direction. Then what each of its parameters does, on
spheres.
"""

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.transforms import blended_transform_factory

from brdffit.albedo import directional_albedo
from brdffit.geometry import direction
from brdffit.models import GGX, BlinnPhong, Phong, PhongOriginal
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import COLOURS, DASHES, new_figure
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.scene import lit_sphere
from experiments.record import RESULTS, Record, styled

EXPONENTS = (1.0, 10.0, 50.0, 100.0)
SHOWN = 50.0  # exponent of the curves and of the spheres under two lights
SMALL = (1.0, 0.25)  # exponents at which the cut-off is an edge
ANGLES = np.concatenate([np.arange(0, 89), 90 - np.logspace(0, -4, 61)])  # deg
OTHER = np.linspace(0, 89, 90)  # deg
PROFILE = np.linspace(-89, 89.5, 715)  # deg
FIXED = 30.0  # deg, the other direction of the test of reciprocity
CUT_FROM = 60.0  # deg, angle of incidence for the cut-off
BEFORE = 1.0  # deg from the cut-off
SHEET = {"kd": (0.0, 0.5, 1.0), "ks": (0.0, 0.5, 1.0), "p": (1.0, 50.0, 100.0)}
LIGHTS = {"front": (-0.36, 0.48, 0.8), "behind": (-0.48, 0.64, -0.6)}
RESOLUTION = 192
SHEET_RESOLUTION = 96


def matched(exponent, specular=1.0):
    """Four models whose lobe at normal incidence falls to half at the same angle."""
    half = np.arccos(0.5 ** (1 / exponent))  # of the mirrored direction
    tilt = half / 2  # of the half vector
    narrow = np.log(0.5) / np.log(np.cos(tilt))
    alpha = np.tan(tilt) / np.sqrt(np.sqrt(2) / np.cos(tilt) ** 2 - 1)
    lobe = {"diffuse": [0.0], "specular": [specular]}
    return {
        "phong_original": PhongOriginal(**lobe, exponent=exponent),
        "phong": Phong(**lobe, exponent=exponent),
        "blinn_phong": BlinnPhong(**lobe, exponent=narrow),
        "ggx": GGX(diffuse=[0.0], f0=[specular], alpha=min(alpha, 1.0)),
    }


def in_plane(degrees):
    """Directions in the plane of incidence; negative angles are on the light's side."""
    theta = jnp.radians(jnp.asarray(degrees, jnp.float64))
    return jax.vmap(direction)(theta, jnp.full_like(theta, jnp.pi))


@jax.jit
def _albedos(brdf, wi):
    return jax.lax.map(lambda w: directional_albedo(brdf, w)[0], wi)


def albedos(brdf):
    """Directional albedo at all `ANGLES`."""
    return np.asarray(_albedos(brdf, in_plane(-ANGLES)))


@jax.jit
def _reflected(brdf, wi, wo):
    return jax.vmap(brdf)(wi, wo)[:, 0]


def reflected(brdf, theta_i, theta_o):
    """``f_r`` in the plane of incidence, the light on one side, the viewer opposite."""
    wi, wo = (in_plane(a) for a in np.broadcast_arrays(-theta_i, theta_o))
    return np.asarray(_reflected(brdf, wi, wo))


def exceeding(albedo):
    """Angle of incidence beyond which albedo exceeds 1, in degrees, or None."""
    above = albedo > 1 + 1e-6
    if not above.any():
        return None
    n = int(np.argmax(above))
    if n == 0:
        return 0.0
    share = -np.log(albedo[n - 1]) / np.log(albedo[n] / albedo[n - 1])
    return float(ANGLES[n - 1] + share * (ANGLES[n] - ANGLES[n - 1]))


def facts():
    """One row for each exponent and model."""
    rows = []
    for exponent in EXPONENTS:
        for name, brdf in matched(exponent).items():
            albedo = albedos(brdf)
            there = reflected(brdf, FIXED, OTHER)
            back = reflected(brdf, OTHER, FIXED)
            beyond = exceeding(albedo)
            rows.append(
                {
                    "exponent": exponent,
                    "model": name,
                    "albedo_0deg": at(albedo, 0),
                    "albedo_60deg": at(albedo, 60),
                    "albedo_89.9deg": at(albedo, 89.9),
                    "albedo_above_1_beyond_deg": "never" if beyond is None else beyond,
                    "there_over_back_30_80deg": float((there / back)[80]),
                }
            )
    return rows


def at(albedo, degrees):
    """Albedo at one of the angles."""
    return float(albedo[np.argmin(np.abs(ANGLES - degrees))])


def edge(exponent):
    """Share of the peak of the lobe still there just before the cut-off."""
    return np.sin(np.radians(BEFORE)) ** exponent


@styled
def curves():
    """Energy, reciprocity and cut-off."""
    figure = new_figure(11.4, 4.1)
    energy, trade, cut = figure.subplots(1, 3)
    models, albedo = matched(SHOWN), {}
    looks = {
        name: {"color": COLOURS[n], "linestyle": DASHES[n], "label": name}
        for n, name in enumerate(models)
    }
    for name, brdf in models.items():
        albedo[name] = albedos(brdf)
        energy.plot(ANGLES, albedo[name], **looks[name])
        there = reflected(brdf, FIXED, OTHER)
        trade.plot(OTHER, there / reflected(brdf, OTHER, FIXED), **looks[name])
        profile = reflected(matched(SMALL[1])[name], CUT_FROM, PROFILE)
        cut.plot(PROFILE, profile / profile.max(), **looks[name])

    beyond = exceeding(albedo["phong_original"])
    early = exceeding(albedos(matched(10.0)["phong_original"]))
    energy.set(yscale="log", ylim=(0.02, 3), xlim=(0, 90), xticks=range(0, 91, 15))
    energy.axhline(1, color="black", linewidth=0.7)
    energy.text(2, 1.08, "as much as came", size=7)
    energy.set_xlabel(r"angle of incidence $\theta_i$ (degrees)")
    energy.set_ylabel("directional albedo, log scale")
    energy.set_title(
        f"Energy, p = {SHOWN:g}: the original sends back more than\n"
        f"came beyond {beyond:.2f} degrees (p = 10: {early:.1f})"
    )

    worst = np.cos(np.radians(80)) / np.cos(np.radians(FIXED))
    trade.set(yscale="log", xlim=(0, 90), xticks=range(0, 91, 15))
    trade.set_xlabel(rf"other angle $\theta$ (degrees), one is {FIXED:g}")
    both = rf"$f_r({FIXED:g}°\to\theta)\,/\,f_r(\theta\to{FIXED:g}°)$"
    trade.set_ylabel(f"{both}, log scale")
    trade.text(4, 0.6, "the other three: 1,\nas it must be", size=7, va="top")
    trade.set_title(
        "Reciprocity: the original changes by a factor\n"
        f"of {1 / worst:.1f} when light and viewer swap {FIXED:g} and 80 degrees"
    )

    cut.set(xlim=(-90, 90), xticks=range(-90, 91, 30), ylim=(0, 1.05))
    mark = CUT_FROM - 90
    cut.axvline(mark, color="black", linewidth=0.7)
    cut.text(
        mark - 2,
        0.97,
        "90° from the\nmirror direction",
        size=7,
        ha="right",
        va="top",
        transform=blended_transform_factory(cut.transData, cut.transAxes),
    )
    cut.set_xlabel(rf"viewer $\theta_o$ (degrees), light at {-CUT_FROM:g}")
    cut.set_ylabel("lobe / its largest value (1)")
    cut.set_title(
        f"Cut-off, p = {SMALL[1]:g}: {100 * edge(SMALL[1]):.0f} % of both Phong lobes\n"
        f"are left {BEFORE:g} degree before the edge, nothing beyond"
    )
    figure.legend(
        *energy.get_legend_handles_labels(), loc="outside lower center", ncols=4
    )
    return figure


def spheres(models, scene):
    """Images of one channel, NaN beside the sphere."""
    samples = trace(scene, channels=1)
    return {
        name: samples.pixels.images(np.asarray(compiled_shade(brdf, samples)))[0]
        for name, brdf in models.items()
    }


@styled
def lit():
    """Four models on spheres: a light in front, one behind, and a small exponent."""
    rows = {
        f"light in front\np = {SHOWN:g}, ks = 0.1": (LIGHTS["front"], SHOWN, 0.1),
        f"light behind\np = {SHOWN:g}, ks = 0.1": (LIGHTS["behind"], SHOWN, 0.1),
        f"light in front\np = {SMALL[1]:g}, ks = 0.5": (
            LIGHTS["front"],
            SMALL[1],
            0.5,
        ),
    }
    figure = new_figure(8.0, 6.6)
    grid = figure.subplots(len(rows), 4)
    front, rim = {}, {}
    for line, (label, (light, exponent, specular)) in zip(
        grid, rows.items(), strict=True
    ):
        scene = lit_sphere(RESOLUTION, [light], np.pi)
        found = spheres(matched(exponent, specular), scene)
        for axes, (name, image) in zip(line, found.items(), strict=True):
            plot_sphere(axes, image)
            peak = np.nanmax(image)
            axes.set_title(f"{name}\nbrightest {peak:.2g}", size=8)
            if exponent == SHOWN:
                (rim if light == LIGHTS["behind"] else front)[name] = peak
        line[0].text(
            -0.08,
            0.5,
            label,
            transform=line[0].transAxes,
            rotation=90,
            ha="center",
            va="center",
            size=8,
        )
    fall = {name: rim[name] / front[name] for name in rim}
    figure.suptitle(
        "Lobes alone, equally wide. Towards grazing the original's highlight keeps "
        f"{100 * fall['phong_original']:.0f} %\nof its brightness, that of `phong` "
        f"{100 * fall['phong']:.0f} %, that of `ggx` {100 * fall['ggx']:.0f} %"
    )
    figure.supxlabel("1 is a white diffuse surface that faces the light; sRGB", size=8)
    return figure


@styled
def sheet():
    """Every combination of the parameters of the shading equation, as spheres."""
    figure = new_figure(9.6, 4.3)
    blocks = figure.subfigures(1, len(SHEET["p"]))
    scene = lit_sphere(SHEET_RESOLUTION, [LIGHTS["front"]], 1.0)
    brightest = 0.0
    for block, exponent in zip(blocks, SHEET["p"], strict=True):
        grid = block.subplots(3, 3)
        models = {
            (kd, ks): PhongOriginal(diffuse=[kd], specular=[ks], exponent=exponent)
            for kd in SHEET["kd"]
            for ks in SHEET["ks"]
        }
        found = spheres(models, scene)
        for axes, ((kd, ks), image) in zip(grid.flat, found.items(), strict=True):
            plot_sphere(axes, image)
            axes.set_title(f"kd {kd:g}, ks {ks:g}", size=7, pad=2)
            brightest = max(brightest, float(np.nanmax(image)))
        block.suptitle(f"p = {exponent:g}", size=9)
    figure.suptitle(
        "kd (n.l) + ks (r.v)^p: kd lifts the base, ks the highlight, p narrows it; "
        "p = 1 ends in an edge"
    )
    figure.supxlabel(
        "1 is a white diffuse surface that faces the light; what exceeds it, up to "
        f"{brightest:.2f} where kd + ks > 1, is drawn white; sRGB",
        size=8,
    )
    return figure


def main(folder=RESULTS / "original_phong"):
    """Write table and figures."""
    record = Record(folder)
    with jax.enable_x64(True):
        rows = facts()
        record.figure(curves())
    record.table(rows)
    record.table(
        [{"exponent": p, "lobe_left_1deg_before_cut": edge(p)} for p in SMALL], "cut"
    )
    record.figure(lit(), "spheres")
    record.figure(sheet(), "parameters")
    worst = max(
        (row for row in rows if row["model"] == "phong_original"),
        key=lambda row: row["albedo_89.9deg"],
    )
    record.close(
        finding=f"At 89.9 degrees the original model reflects up to "
        f"{worst['albedo_89.9deg']:.3g} times the light that arrives, with exponent "
        f"{worst['exponent']:g}.",
        shown_exponent=SHOWN,
    )


if __name__ == "__main__":
    main()
