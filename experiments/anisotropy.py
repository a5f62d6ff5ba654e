"""Which way does a field of tangents stretch the highlight of an anisotropic surface?

Three models with grooves or fibres along the tangent, three fields of tangents on a
sphere under one light. They should stretch it across the grooves. The highlight is what
exceeds half of the brightest pixel; its axes are those of its second moments. An
isotropic model must not see the field.
"""

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from brdffit.geometry import TANGENTS
from brdffit.models import GGX, Banks, GGXAnisotropic, WardBounded
from brdffit.plots.spheres import plot_sphere
from brdffit.plots.style import new_figure
from brdffit.render import trace
from brdffit.render.shading import compiled_shade
from brdffit.scene import lit_sphere
from experiments.record import RESULTS, Record, styled

LIGHT = (-0.48, 0.36, 0.8)
RESOLUTION = 160
STROKE = 0.07  # half the length of a drawn tangent, in radii of the sphere
FIELDS = {
    "linear": "along x",
    "radial": "away from the viewing axis",
    "cylindrical": "around y",
}
DIFFUSE = [0.12, 0.06, 0.03]
WIDTHS = {"alpha_x": 0.1, "alpha_y": 0.4}  # along the tangent, across it
MODELS = {
    "ward_bounded": WardBounded(diffuse=DIFFUSE, specular=[0.4] * 3, **WIDTHS),
    "ggx_anisotropic": GGXAnisotropic(diffuse=DIFFUSE, f0=[0.4] * 3, **WIDTHS),
    "banks": Banks(diffuse=DIFFUSE, specular=[0.4] * 3, exponent=60.0),
}
CONTROL = GGX(diffuse=DIFFUSE, f0=[0.4] * 3, alpha=0.2)


def image(brdf, field, resolution):
    """A sphere, NaN beside it."""
    samples = trace(lit_sphere(resolution, [LIGHT], np.pi, tangents=field))
    return samples.pixels.images(np.asarray(compiled_shade(brdf, samples)))[0]


def highlight(picture):
    """Ratio of the axes of the highlight, and angle of the long one to x in degrees."""
    grey = np.nan_to_num(picture.mean(axis=-1))
    row, column = np.nonzero(grey > grey.max() / 2)
    moments = np.cov(np.stack([column, -row]).astype(float))
    sizes, axes = np.linalg.eigh(moments)
    x, y = axes[:, 1]
    return np.sqrt(sizes[1] / sizes[0]), np.degrees(np.arctan2(y, x)) % 180


def strokes(axes, field):
    """Tangents on a sphere as the camera sees them, where they run across its view."""
    grid = np.linspace(-0.9, 0.9, 10)
    x, y = (a.ravel() for a in np.meshgrid(grid, grid))
    x, y = x[x * x + y * y < 0.85], y[x * x + y * y < 0.85]
    normals = np.stack([x, y, np.sqrt(1 - x * x - y * y)], axis=1)
    along = STROKE * np.asarray(jax.vmap(TANGENTS[field])(jnp.asarray(normals)))
    ends = np.stack([normals - along, normals + along], axis=1)[..., :2]
    axes.add_collection(LineCollection(ends, colors="black", linewidths=0.8))
    axes.add_patch(Circle((0, 0), 1, fill=False, linewidth=0.8))
    axes.set(xlim=(-1.05, 1.05), ylim=(-1.05, 1.05), aspect="equal")
    axes.axis("off")
    axes.set_title(f"tangents {field}\n({FIELDS[field]})")


@styled
def chart(pictures, rows):
    """Fields across; the tangents themselves, then one model after another."""
    figure = new_figure(6.6, 9.0)
    grid = figure.subplots(1 + len(MODELS), len(TANGENTS))
    for axes, field in zip(grid[0], TANGENTS, strict=True):
        strokes(axes, field)
    found = {(row["model"], row["tangents"]): row for row in rows}
    for axes, (key, picture) in zip(grid[1:].flat, pictures.items(), strict=True):
        plot_sphere(axes, picture, 0.9 / float(np.nanmax(picture)))
        row = found[key]
        axes.set_title(f"{key[0]}\n{row['axes']:.1f} : 1 at {row['angle_deg']:.0f}°")
    longest = max(rows, key=lambda row: row["axes"])
    figure.suptitle(
        "Highlights stretch across the tangents, "
        f"up to {longest['axes']:.1f} : 1 ({longest['model']})"
    )
    figure.supxlabel(
        "Numbers: axes of what exceeds half of the brightest pixel, and angle of the\n"
        "long one from x, counter-clockwise. sRGB, each sphere to its brightest pixel.",
        size=8,
    )
    return figure


def main(folder=RESULTS / "anisotropy", resolution=RESOLUTION):
    """Write table and figure."""
    record = Record(folder)
    pictures = {
        (name, field): image(brdf, field, resolution)
        for name, brdf in MODELS.items()
        for field in TANGENTS
    }
    rows = []
    for (name, field), picture in pictures.items():
        ratio, angle = highlight(picture)
        brightest = float(np.nanmax(picture))
        row = {"model": name, "tangents": field, "axes": float(ratio)}
        rows.append(row | {"angle_deg": float(angle), "brightest": brightest})
    record.table(rows)
    record.figure(chart(pictures, rows))
    same = [image(CONTROL, field, resolution) for field in TANGENTS]
    apart = max(float(np.nanmax(np.abs(one - same[0]))) for one in same)
    apart /= float(np.nanmax(same[0]))
    print(f"isotropic ggx: fields differ by {apart:.1g} of the brightest pixel at most")
    straight = [row["axes"] for row in rows if row["tangents"] != "radial"]
    record.close(
        finding=f"Along straight grooves the highlight is {min(straight):.1f} to "
        f"{max(straight):.1f} times as long as wide.",
        isotropic_difference=apart,
    )


if __name__ == "__main__":
    main()
