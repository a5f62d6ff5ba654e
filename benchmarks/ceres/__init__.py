"""Ceres as a contestant: C++ compiled here, called in this process."""

import ctypes
import functools
import shutil
import subprocess
import tempfile
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.measure import Contestant
from benchmarks.problems import Problem
from brdffit.parameters import registry_name

SOURCE = Path(__file__).parent / "fit.cc"
TEXTURE = SOURCE.with_name("texture.cc")
COMPILER = "g++"
OPTIONS = ("-std=c++17", "-O3", "-march=native", "-shared", "-fPIC")
INCLUDES, LIBRARIES = "/usr/include/eigen3", ("-lceres", "-lglog")
HEADER = Path("/usr/include/ceres/ceres.h")


def why_absent() -> str | None:
    """A sentence that says what is missing, or None when Ceres can be used."""
    if shutil.which(COMPILER) is None:
        return f"Ceres is left out: there is no compiler `{COMPILER}`."
    if not HEADER.exists():
        return "Ceres is left out: Debian's `libceres-dev` is not installed."
    return None


@functools.cache
def library(source: Path = SOURCE) -> ctypes.CDLL:
    """A compiled program; each is built once per process, in a temporary folder."""
    folder = Path(tempfile.mkdtemp(prefix="brdffit-ceres-"))
    try:
        built = folder / "program.so"
        command = (COMPILER, *OPTIONS, f"-I{INCLUDES}", source, "-o", built)
        subprocess.run((*command, *LIBRARIES), check=True)
        loaded = ctypes.CDLL(str(built))
    finally:
        shutil.rmtree(folder)
    if source == SOURCE:
        loaded.fit_make.restype = ctypes.c_void_p
    return loaded


class Fit:
    """A problem that Ceres holds, for as long as this object lives."""

    def __init__(self, problem: Problem, automatic: bool):
        """Build one residual block per sample."""
        self.arrays, self.x0 = problem.arrays, problem.x0  # Ceres reads them in place
        wi = self.arrays[0]
        self.handle = ctypes.c_void_p(
            library().fit_make(
                registry_name(problem.start).encode(),
                ctypes.c_bool(problem.residual.name == "log"),
                ctypes.c_bool(automatic),
                *(len(wi), wi.shape[1], len(self.x0)),
                *(_pointer(array) for array in self.arrays),
            )
        )
        if not self.handle:
            raise ValueError(
                f"Model `{registry_name(problem.start)}` is not in {SOURCE}."
            )

    def __del__(self):
        """Give back what Ceres holds."""
        library().fit_free(self.handle)

    def solve(self, threads: int, tolerance: float) -> tuple[np.ndarray, int]:
        """Solve from the start; the point reached and the number of steps."""
        x = self.x0.copy()
        steps = library().fit_solve(
            self.handle, _pointer(x), threads, ctypes.c_double(tolerance)
        )
        return (x if steps >= 0 else np.full_like(x, np.nan)), steps


def contestants(problem: Problem) -> list[Contestant]:
    """Ceres with derivatives by hand on one thread and on two, and with its own.

    Levenberg-Marquardt on dense normal equations, its fastest for so few unknowns. None
    where it cannot be built; a sentence says why.
    """
    if why := why_absent():
        print(why)
        return []
    analytic, automatic = Fit(problem, automatic=False), Fit(problem, automatic=True)
    return [
        Contestant("Ceres analytic", partial(analytic.solve, 1)),
        Contestant(
            "Ceres, 2 threads, on the wall", partial(analytic.solve, 2), threads=2
        ),
        Contestant("Ceres autodiff", partial(automatic.solve, 1)),
    ]


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    return array.ctypes.data_as(ctypes.c_void_p)
