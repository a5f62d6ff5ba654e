"""Stand-ins for MERL materials, from tiny networks that were trained on them.

They are files of real size in the layout of MERL's, but not MERL's data: where the
networks differ from the materials, off the highlight, it is by 5 % in the median, and
highlights of metals are up to a half too low.

Source:
    A. Sztrajman, G. Rainer, T. Ritschel, T. Weyrich, "Neural BRDF Representation and
    Importance Sampling", Computer Graphics Forum 40(6), 2021,
    https://doi.org/10.1111/cgf.14335
"""

import os
from pathlib import Path

import numpy as np

from brdffit import half_difference
from brdffit.samples import Measurement
from brdffit.writers.merl import SCALES
from experiments.record import RESULTS

DATA = Path(os.environ.get("BRDFFIT_DATA", RESULTS.parents[1] / "shared" / "data"))
WEIGHTS = DATA / "merl_standins" / "nbrdf_weights.npz"


def names():
    """Names of all materials there are stand-ins for."""
    return [str(name) for name in np.load(WEIGHTS)["names"]]


def stand_in(name):
    """Values of one network at the cells of a MERL file, such as the file can hold."""
    stored = np.load(WEIGHTS)
    place = names().index(name)
    layers = [(stored[f"fc{n}"][place], stored[f"b{n}"][place]) for n in (1, 2, 3)]
    wi, wo, solid_angle = half_difference.cells()
    values = inputs()
    for number, (weight, bias) in enumerate(layers):
        values = values @ weight + bias
        values = np.maximum(values, 0) if number < 2 else np.expm1(values)
    above = (wi[:, 2] > 1e-6) & (wo[:, 2] > 1e-6)
    return Measurement(
        wi=wi,
        wo=wo,
        f_r=np.maximum(values, 0).astype(np.float64) / SCALES * SCALES,
        mask=np.repeat(above[:, None], 3, axis=1),
        solid_angle=solid_angle,
        channels=("R", "G", "B"),
        name=f"{name} (stand-in)",
    )


def inputs():
    """Half vector of azimuth 0 and difference direction of every cell ``(N, 6)``."""
    centres = [(np.arange(count) + 0.5) / count for count in half_difference.SHAPE]
    theta_h, theta_d, phi_d = np.meshgrid(
        centres[0] ** 2 * np.pi / 2,
        centres[1] * np.pi / 2,
        centres[2] * np.pi,
        indexing="ij",
    )
    parts = [
        np.sin(theta_h),
        np.zeros_like(theta_h),
        np.cos(theta_h),
        np.sin(theta_d) * np.cos(phi_d),
        np.sin(theta_d) * np.sin(phi_d),
        np.cos(theta_d),
    ]
    return np.stack(parts, axis=-1).reshape(-1, 6).astype(np.float32)
