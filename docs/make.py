"""Make the pictures of the README, from data that belong to the repository.

python docs/make.py
"""

from pathlib import Path

import brdffit
from brdffit import plots
from brdffit.cli.demo import EXAMPLE

HERE = Path(__file__).parent
SPHERE = HERE.parent / "data_synthetic" / "cook_torrance_three_lights.exr"
DOTS_PER_INCH = 90


def main() -> None:
    """Fit the bundled table and a synthetic sphere, and draw both."""
    paint = brdffit.load(EXAMPLE)
    models = ["ggx+ggx_lobe", "ggx", "cook_torrance", "phong"]
    results = brdffit.compare(paint, models).results
    figure = plots.lobe_figure(paint, results)
    figure.savefig(HERE / "lobes.png", dpi=DOTS_PER_INCH)

    sphere = brdffit.load(SPHERE)
    results = brdffit.compare(sphere, ["cook_torrance", "phong", "oren_nayar"]).results
    figure = plots.spheres_figure(sphere, results)
    figure.savefig(HERE / "spheres.png", dpi=DOTS_PER_INCH)


if __name__ == "__main__":
    main()
