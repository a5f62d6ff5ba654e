"""Which way does a field of tangents stretch the highlight of an anisotropic surface?

Three models with grooves or fibres along the tangent, three fields of tangents on a
sphere under one light. The highlight is what exceeds half of the brightest pixel; its
axes are those of its second moments. An isotropic model must not see the field.
"""

import numpy as np

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
    samples = trace(lit_sphere(resolution, [LIGHT], np.pi, tangents=field), 3)
    return samples.pixels.images(np.asarray(compiled_shade(brdf, samples)))[0]


def highlight(picture):
    """Ratio of the axes of the highlight, and angle of the long one to x in degrees."""
    grey = np.nan_to_num(picture.mean(axis=-1))
    row, column = np.nonzero(grey > grey.max() / 2)
    moments = np.cov(np.stack([column, -row]).astype(float))
    sizes, axes = np.linalg.eigh(moments)
    x, y = axes[:, 1]
    return np.sqrt(sizes[1] / sizes[0]), np.degrees(np.arctan2(y, x)) % 180


@styled
def chart(pictures, rows):
    """Models down, fields across."""
    figure = new_figure(6.4, 7.0)
    grid = figure.subplots(len(MODELS), len(TANGENTS))
    found = {(row["model"], row["tangents"]): row for row in rows}
    for axes, (key, picture) in zip(grid.flat, pictures.items(), strict=True):
        plot_sphere(axes, picture, 0.9 / float(np.nanmax(picture)))
        row = found[key]
        axes.set_title(
            f"{key[0]}, {key[1]}\n{row['axes']:.1f} : 1 at {row['angle_deg']:.0f} deg"
        )
    longest = max(rows, key=lambda row: row["axes"])
    figure.suptitle(
        f"Highlights of one light, up to {longest['axes']:.1f} : 1 "
        f"({longest['model']}, {longest['tangents']}), turn with the tangents"
    )
    figure.supxlabel(
        "half-brightness region: ratio of its axes, long one from x, "
        "counter-clockwise; sRGB, each sphere to its brightest pixel",
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
    record.close(isotropic_difference=apart)


if __name__ == "__main__":
    main()
