r"""A material of the RGL database, evaluated in its adaptive parameterisation.

For each direction of incidence a file holds the reflectance at points that were placed
where the material is bright: a warp of the unit square takes them to directions of the
half vector. With $u(\theta, \phi) = (\sqrt{2\theta/\pi}, (\phi + \pi) / 2\pi)$,

$$f_r\cos\theta_o = \frac{D(u_h)}{4\,\sigma(u_i)}\,R\bigl(w^{-1}(u_h)\bigr),$$

where D, sigma and R are tables and w is the warp by the table of visible normals.

Source:
    J. Dupuy and W. Jakob, "An Adaptive Parameterization for Efficient Material
    Acquisition and Rendering", SIGGRAPH Asia 2018,
    https://doi.org/10.1145/3272127.3275059
"""

from pathlib import Path

import numpy as np

from brdffit.readers import tensor_file
from brdffit.readers.adaptive_warp import Table, Warp
from brdffit.types import Values, Vectors

AT_ONCE = 4096  # pairs of directions; bounds the memory that interpolation needs


class Material:
    """A material of the database.

    Attributes:
        name: Its description.
        channels: R, G, B or the wavelengths.
        theta_i: Polar angles of incidence that were measured.
        phi_i: Azimuths of incidence that were measured.
        isotropic: Whether azimuths of the half vector count from that of the light.
        warp: By the density of visible normals, from the square of the table of
            reflectance to the square of directions.
        reflectance: Table over the uniform square.
    """

    def __init__(self, path: Path | str):
        """Read a file.

        Raises:
            ValueError: The file is damaged or is no material of the database.
            OSError: The file cannot be read.
        """
        self._path = Path(path)
        self._arrays = tensor_file.read(path)
        self.theta_i = self._floats("theta_i", 1).astype(np.float64)
        self.phi_i = self._floats("phi_i", 1).astype(np.float64)
        grid = (len(self.phi_i), len(self.theta_i))
        if "spectra" in self._arrays:
            wavelengths = self._floats("wavelengths", 1)
            self.channels = tuple(f"{length:g} nm" for length in wavelengths)
            reflectance = self._floats("spectra", 5, *grid, len(wavelengths))
        else:
            self.channels = ("R", "G", "B")
            reflectance = self._floats("rgb", 5, *grid, 3)
        nodes = (self.phi_i, self.theta_i)
        try:
            self.warp = Warp(self._floats("vndf", 4, *grid), *nodes)
        except ValueError as error:
            raise self._error(f"array `vndf` is no density: {error}") from error
        self.reflectance = Table(reflectance, *nodes, channels=len(self.channels))
        self._ndf = Table(self._floats("ndf", 2))
        self._sigma = Table(self._floats("sigma", 2))
        # One or two azimuths of incidence: the material is isotropic, and azimuths of
        # the half vector count from that of the light.
        self.isotropic = len(self.phi_i) <= 2
        self._scaled = bool(self._arrays.get("jacobian", np.ones(1)).any())
        self.name = self._description()

    @np.errstate(all="ignore")  # a damaged table gives NaN, not a warning
    def __call__(self, wi: Vectors, wo: Vectors) -> Values:
        """Reflectance ``f_r (N, C)``; 0 where a direction is not above the horizon."""
        wi, wo = np.asarray(wi, np.float64), np.asarray(wo, np.float64)
        f_r = np.zeros((len(wi), len(self.channels)))
        seen = np.flatnonzero((wi[:, 2] > 0) & (wo[:, 2] > 0))
        for start in range(0, len(seen), AT_ONCE):
            rows = seen[start : start + AT_ONCE]
            f_r[rows] = self._evaluate(*self._folded(wi[rows], wo[rows]))
        return f_r

    def _evaluate(self, wi: Vectors, wo: Vectors) -> Values:
        half = wi + wo
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        theta_i, phi_i = angles(wi)
        theta_h, phi_h = angles(half)
        u_i = square(theta_i, phi_i)
        u_h = square(theta_h, phi_h - phi_i if self.isotropic else phi_h)
        u_h[:, 1] -= np.floor(u_h[:, 1])
        slices = self.warp.slices(phi_i, theta_i)
        value = self.reflectance(self.warp.invert(u_h, slices), slices)
        return value * self.scale(u_i, u_h) / wo[:, 2:]

    def scale(self, u_i: np.ndarray, u_h: np.ndarray) -> np.ndarray:
        """``D / (4 sigma)``, or 1 in files whose reflectance holds it already."""
        if not self._scaled:
            return np.ones((len(u_h), 1))
        sigma = self._sigma(u_i, self._sigma.slices())
        return self._ndf(u_h, self._ndf.slices()) / (4 * sigma)

    def _folded(self, wi: Vectors, wo: Vectors) -> tuple[Vectors, Vectors]:
        """Directions turned into the part of the circle that was measured.

        Half of the azimuths are enough for a surface that looks the same when turned
        by 180 degrees, a quarter for one that also has a plane of symmetry.
        """
        span = np.ptp(self.phi_i)
        parts = 1 if self.isotropic or span == 0 else round(2 * np.pi / float(span))
        if parts < 2:
            return wi, wo
        sign = -np.where(wi[:, :2] < 0, -1.0, 1.0)
        if parts < 4:
            sign[:, 0] = sign[:, 1]
        flip = np.concatenate([sign, np.ones((len(wi), 1))], axis=1)
        return wi * flip, wo * flip

    def _floats(self, name: str, dimensions: int, *sizes: int) -> np.ndarray:
        """An array of the file, whose first sizes must be these."""
        array = self._arrays.get(name)
        if array is None:
            raise self._error(f"it has no array `{name}`")
        fits = array.ndim == dimensions and array.shape[: len(sizes)] == sizes
        if not fits or array.dtype.kind != "f" or not array.size:
            raise self._error(f"array `{name}` has shape {array.shape}")
        if dimensions > 1 and min(array.shape[-2:]) < 2:
            raise self._error(f"the grid of array `{name}` is smaller than 2 x 2")
        if dimensions == 1 and not (
            np.isfinite(array).all() and (np.diff(array) > 0).all()
        ):
            raise self._error(f"array `{name}` does not increase")
        return array

    def _description(self) -> str:
        text = self._arrays.get("description", np.zeros(0, "u1")).tobytes()
        return " ".join(text.decode(errors="replace").split()) or self._path.stem

    def _error(self, reason: str) -> ValueError:
        return ValueError(f"`{self._path}` is not a complete RGL material: {reason}.")


def angles(w: Vectors) -> tuple[np.ndarray, np.ndarray]:
    """Polar angle, exact near the normal too, and azimuth."""
    x, y, z = w.T
    chord = np.sqrt(x * x + y * y + (z - 1) ** 2)
    return 2 * np.arcsin(np.clip(chord / 2, 0, 1)), np.arctan2(y, x)


def square(theta: np.ndarray | float, phi: np.ndarray | float) -> np.ndarray:
    """Points of the unit square for polar angles and azimuths."""
    return np.stack([np.sqrt(theta * 2 / np.pi), (phi + np.pi) / (2 * np.pi)], axis=-1)
