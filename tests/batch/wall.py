"""A painted wall: texels of a Lambertian surface, and the chunks of its fit."""

from pathlib import Path

import numpy as np

import brdffit
from brdffit.batch.stack import save_stack
from brdffit.batch.texture import FITS, import_zarr
from brdffit.fit.texels import Texels

CHUNK = 256
OBSERVATIONS = 6


def texels(count, seed=0):
    """Texels seen under random lights, with 1 % noise."""
    draw = np.random.default_rng(seed)
    z, turn = draw.uniform(0.4, 1, (2, OBSERVATIONS, count))
    radius, phi = np.sqrt(1 - z * z), 2 * np.pi * turn
    wi = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=1)
    wo = np.broadcast_to(np.array([[0.0], [0.0], [1.0]]), (OBSERVATIONS, 3, 1))
    albedo = draw.uniform(0.1, 0.9, (3, count))
    noise = 1 + 0.01 * draw.standard_normal((OBSERVATIONS, 3, count))
    value = albedo / np.pi * z[:, None] * noise
    single = [np.asarray(a, np.float32) for a in (wi, wo, z[:, None], value)]
    return Texels(*single)


def wall(path, chunks, short=0):
    """A stack of so many chunks on disk, the last of which may lack some texels."""
    sizes = [CHUNK] * (chunks - 1) + [CHUNK - short]
    return save_stack(path, (texels(size, seed) for seed, size in enumerate(sizes)))


def fit(stack, out, **options):
    """Fit the wall."""
    return brdffit.fit_texture("lambert", stack, out, chunk=CHUNK, **options)


def numbers(out):
    """Every array of a run by name."""
    group = import_zarr().open_group(Path(out) / FITS, mode="r")
    return {
        name: np.asarray(array)
        for name, array in group.members(max_depth=None)
        if hasattr(array, "dtype")
    }


def same(one, other):
    """Whether two runs have the very same numbers."""
    first, second = numbers(one), numbers(other)
    assert first.keys() == second.keys()
    for name, array in first.items():
        np.testing.assert_array_equal(array, second[name], err_msg=name)


if __name__ == "__main__":
    import sys

    brdffit.enable_compilation_cache()
    fit(sys.argv[1], sys.argv[2], resume=True)
