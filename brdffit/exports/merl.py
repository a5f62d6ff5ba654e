"""MERL binary: f_r at the centres of the cells, for whatever reads measured materials.

Between the centres a renderer takes the nearest cell, as here, or interpolates; so a
lobe narrower than a cell, half a degree at the highlight, is lost.
"""

from collections.abc import Sequence

import numpy as np

from brdffit import half_difference
from brdffit.exports.material import Material, evaluator, in_rgb
from brdffit.models import AbstractBRDF
from brdffit.parameters import registry_name
from brdffit.samples import Measurement
from brdffit.types import Values, Vectors
from brdffit.writers import merl

DESCRIPTION = "MERL binary, a table on half and difference angles"
SUFFIX = ".binary"
AT_ONCE = 2**17  # directions evaluated together, which bounds memory


def translate(brdf: AbstractBRDF, channels: Sequence[str] = ()) -> Material:
    """Tabulate a BRDF.

    Raises:
        ValueError: It is anisotropic, or has more channels than colours.
    """
    brdf = in_rgb(brdf, "MERL", channels)
    if not brdf.isotropic:
        raise ValueError(
            f"Model `{registry_name(brdf)}` cannot be written as a MERL file, which "
            f"holds isotropic materials only: export it to glsl."
        )
    data = tabulated(brdf)
    return Material(
        evaluate=lambda wi, wo: nearest(data, wi, wo),
        write=lambda path: merl.save(data, path),
        parameters={"cells": half_difference.COUNT},
        evaluator="the table, looked up at the nearest cell",
        notes=("A MERL file is a table; between its cells the nearest is taken.",),
    )


def tabulated(brdf: AbstractBRDF) -> Measurement:
    """f_r at the centres of all cells; those below the horizon are masked."""
    wi, wo, solid_angle = half_difference.cells()
    evaluate = evaluator(brdf)
    f_r = np.empty((len(wi), brdf.channels))
    for start in range(0, len(wi), AT_ONCE):
        rows = slice(start, start + AT_ONCE)
        f_r[rows] = evaluate(wi[rows], wo[rows])
    above = (wi[:, 2] > 0) & (wo[:, 2] > 0)
    return Measurement(
        wi=wi,
        wo=wo,
        f_r=f_r,
        mask=np.repeat(above[:, None], brdf.channels, axis=1),
        solid_angle=solid_angle,
        channels=("R", "G", "B"),
        name=registry_name(brdf),
    )


def nearest(data: Measurement, wi: Vectors, wo: Vectors) -> Values:
    """Values of the cells that directions fall into."""
    return np.asarray(data.f_r)[half_difference.cell_of(wi, wo)]
