"""RGL material database: measured materials, isotropic or anisotropic.

The files are tensor files (see `brdffit.readers.tensor_file`) with the tables of an
adaptive parameterisation (see `brdffit.readers.rgl_material`). RGB files have three
channels, which may be negative where a colour lies outside of the gamut; spectral files
have one for each wavelength.
"""

from pathlib import Path

from brdffit.readers import tensor_file, validity
from brdffit.readers.rgl_material import Material
from brdffit.readers.rgl_nodes import nodes
from brdffit.samples import Measurement
from brdffit.types import Values, Vectors

DESCRIPTION = "RGL material: measured reflectance in an adaptive parameterisation"
SUFFIXES = (".bsdf",)
BEGINS = "with the word `tensor_file`"


def matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    """Whether a file begins as a tensor file does."""
    return head.startswith(tensor_file.MAGIC)


def load(path: Path | str) -> Measurement:
    """Reflectance at the points where the material was measured.

    ``solid_angle`` is what each stands for among the directions to the viewer, in sr.
    Negative values are kept and masked.

    Raises:
        ValueError: The file is damaged or is no material of the database.
        OSError: The file cannot be read.
    """
    material = Material(path)
    wi, wo, f_r, solid_angle = nodes(material)
    return validity.measurement(
        path,
        wi,
        wo,
        f_r,
        solid_angle=solid_angle,
        channels=material.channels,
        name=material.name,
    )


def evaluate(path: Path | str, wi: Vectors, wo: Vectors) -> Values:
    """Reflectance ``f_r (N, C)`` of the material in a file at any directions.

    0 where a direction lies at or below the horizon. RGB may be negative.

    Raises:
        ValueError: The file is damaged or is no material of the database.
        OSError: The file cannot be read.
    """
    return Material(path)(wi, wo)
