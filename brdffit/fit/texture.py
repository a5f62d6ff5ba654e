"""Many small fits: one model, fitted to every texel of a texture on its own.

Texels are solved in blocks of equal size, so that one compiled program serves all, and
on one thread more than there are cores. A screen of a few starts and a few steps are
enough for most; the others are gathered and go on in blocks of their own.
"""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import repeat
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.catalogue import from_name
from brdffit.compiled import ELEMENTWISE, compiled
from brdffit.fit.conditions import Numbers, held_values, hold_at
from brdffit.fit.residual import RESIDUALS, Residual, cosine_weighted
from brdffit.fit.start import spread_starts
from brdffit.fit.texel_basis import TexelBlock, TexelProblem
from brdffit.fit.texel_errors import Found, examine
from brdffit.fit.texel_solve import Progress, begun, solve
from brdffit.fit.texels import TexelFits as TexelFits, Texels as Texels
from brdffit.fit.transforms import Layout, bounds, channel_models
from brdffit.models import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import registry_name
from brdffit.processor import cores

SIZE = 1024  # texels in a block: few enough for the cache, enough to be worth a call
STARTS = {0: 1, 1: 4}  # by number of nonlinear parameters
MORE_STARTS = 24
# of each round; texels that need more go on without the others
STEPS = (6, 8, 16, 32)
MAX_ROUNDS = len(STEPS)


@partial(compiled, options=ELEMENTWISE)
def _fits(
    problem, block, begin, starts, tried, most, known_sigma
) -> tuple[Progress, Found]:
    """A block begun or gone on with, and examined, in one program; see `solve`."""
    solved = solve(problem, block, begin, starts, tried, most)
    return solved.progress, examine(problem, solved, known_sigma)


def fit_texels(
    model: str | AbstractBRDF,
    texels: Texels,
    *,
    residual: str | Residual | None = None,
    fixed: Mapping[str, Numbers] | None = None,
    max_rounds: int = MAX_ROUNDS,
    threads: int | None = None,
) -> TexelFits:
    """Fit the parameters of a model to each texel, in single precision.

    The same declarations and the same equations as in `brdffit.fit`, for many texels
    side by side. What is found for a texel does not depend on the others.

    Args:
        model: Name of a model, or of a sum such as ``ggx+ggx_lobe``, which takes the
            channels of the data; or a model, whose values do not matter.
        texels: What to explain.
        residual: Comparison whose squares are minimised, by name or itself; by default
            `cosine_weighted`, which for radiance is the difference itself.
        fixed: Parameters to hold in all texels, with their values.
        max_rounds: Rounds of steps after which a texel that does not converge is given
            up.
        threads: Number of threads; by default one more than cores, so that none waits
            for a thread that reads or writes.

    Returns:
        Parameters of all texels with their errors. One that stopped early or has too
        few usable values raises nothing: see ``converged``.

    Raises:
        ValueError: An unknown name, a parameter outside its interval, or channels that
            do not match; a sentence says which.
    """
    brdf = from_name(model, texels.channels) if isinstance(model, str) else model
    if brdf.channels != texels.channels:
        raise ValueError(
            f"Model `{registry_name(brdf)}` must have the {texels.channels} channels "
            f"of the texels, but has {brdf.channels}."
        )
    if isinstance(residual, str):
        residual = look_up(RESIDUALS, residual, "Residual")
    problem, starts = _problem(brdf, residual or cosine_weighted, fixed or {})
    # with all values finite, what is used is the same in every channel
    whole = bool(np.isfinite(np.sum(texels.value)))
    known_sigma = texels.sigma is not None

    def of_block(places, begin, tried, steps) -> tuple[Progress, Found]:
        block = _block(texels, places, whole)
        with jax.enable_x64(False):
            found = _fits(problem, block, begin, starts, tried, steps, known_sigma)
            return jax.tree.map(np.asarray, found)

    def advance(places: np.ndarray, begin: Progress, tried: int, steps: int):
        """Texels at these places, each from where it stands, block by block."""
        blocks = _in_blocks(places)
        begins = [jax.tree.map(lambda a, p=p: a[..., p], begin) for p in blocks]
        parts = list(pool.map(of_block, blocks, begins, repeat(tried), repeat(steps)))
        return jax.tree.map(
            lambda *arrays: np.concatenate(arrays, -1)[..., : len(places)], *parts
        )

    begin = begun(jnp.repeat(starts[:1].T, len(texels), axis=1))
    begin = jax.tree.map(np.asarray, begin)
    with ThreadPoolExecutor(threads or cores() + 1) as pool:
        progress, found = advance(np.arange(len(texels)), begin, len(starts), STEPS[0])
        for steps in STEPS[1:max_rounds]:
            rest = np.flatnonzero(found.enough & ~progress.converged)
            if not rest.size:
                break
            again = advance(rest, progress, 0, steps)
            leaves = map(jax.tree.leaves, ((progress, found), again))
            for old, new in zip(*leaves, strict=True):
                old[..., rest] = new
    places = problem.layout.places
    return TexelFits(
        parameters={n: found.natural[list(p)] for n, p in places.items()},
        standard_errors={n: found.standard_errors[list(p)] for n, p in places.items()},
        rms=found.rms,
        converged=progress.converged & found.enough,
        steps=progress.steps,
        at_bound=found.at_bound,
    )


def _problem(
    brdf: AbstractBRDF, residual: Residual, fixed: Mapping[str, Numbers]
) -> tuple[TexelProblem, jax.Array]:
    """What all texels have in common, and where each begins."""
    layout = Layout.of(brdf)
    held = held_values(layout, fixed, registry_name(brdf))
    lower, upper = bounds(layout)
    lower[list(held)] = upper[list(held)] = hold_at(layout, held)
    moving = tuple(name for name in layout.nonlinear if name not in fixed)
    starts = spread_starts(layout, STARTS.get(len(moving), MORE_STARTS))
    starts[:, list(held)] = lower[list(held)]
    single = np.float32
    problem = TexelProblem(
        channels=jax.tree.map(single, channel_models(brdf)),
        lower=jnp.asarray(lower, single),
        upper=jnp.asarray(upper, single),
        layout=layout,
        residual=residual,
        moving=moving,
    )
    return problem, jnp.asarray(starts, single)


def _in_blocks(places: np.ndarray) -> list[np.ndarray]:
    """The places in blocks of equal size; the last repeats its last texel."""
    padded = np.pad(places, (0, -len(places) % SIZE), mode="edge")
    return list(padded.reshape(-1, SIZE))


def _block(texels: Texels, places: np.ndarray, whole: bool) -> TexelBlock:
    """The texels at these places."""
    first, last = int(places[0]), int(places[-1])
    contiguous = last - first == SIZE - 1
    where = slice(first, last + 1) if contiguous else places

    def pick(array) -> Any:
        if array is None:
            return None
        picked = array if array.shape[-1] == 1 < len(texels) else array[..., where]
        exact = bool if array.dtype == bool else np.float32
        return np.ascontiguousarray(picked, exact)

    names = ("wi", "wo", "weight", "value", "mask", "sigma")
    return TexelBlock(**{n: pick(getattr(texels, n)) for n in names}, whole=whole)
