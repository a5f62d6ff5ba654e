"""One fit, from samples to a result."""

import time
from collections.abc import Mapping, Sequence
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.catalogue import from_name
from brdffit.fit.basis import Problem
from brdffit.fit.blocks import blocks, usable
from brdffit.fit.examine import examine
from brdffit.fit.residual import RESIDUALS, Residual, cosine_weighted, log
from brdffit.fit.result import FitResult
from brdffit.fit.search import RTOL, search
from brdffit.fit.start import spread_starts
from brdffit.fit.transforms import (
    Layout,
    bounds,
    channel_models,
    pack,
    to_solver,
)
from brdffit.models import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import check, registry_name, replace, values
from brdffit.samples import Measurement, Samples, as_samples

MAX_STEPS = 200


def fit(
    model: str | AbstractBRDF,
    data: Measurement | Samples,
    *,
    residual: str | Residual | None = None,
    starts: int = 16,
    fixed: Mapping[str, float | Sequence[float]] | None = None,
    precision: str = "float64",
    max_steps: int = MAX_STEPS,
) -> FitResult:
    """Fit the parameters of a model to measured or simulated reflectance.

    Args:
        model: Name of a model, or of a sum such as ``ggx+ggx_lobe``, which takes the
            channels of the data; or a model, whose values are one more start.
        data: What to explain.
        residual: Comparison whose squares are minimised, by name or itself; by default
            `log` for reflectance and `cosine_weighted` for images.
        starts: Number of starts, spread over the typical ranges of the parameters.
        fixed: Parameters to hold, with their values.
        precision: ``"float64"`` or ``"float32"``: that in which models are evaluated.
            Sums are always double, and so are the errors and costs reported.
        max_steps: Number of steps after which a start gives up.

    Returns:
        The best of all starts. A solver that stopped early raises nothing: see
        ``converged`` and ``status``.

    Raises:
        ValueError: An unknown name, a parameter outside its interval, channels that do
            not match, or no usable sample; a sentence says which.
    """
    begin = time.perf_counter()
    if precision not in RTOL:
        raise ValueError(
            f"Precision must be `float64` or `float32`, but is `{precision}`."
        )
    if starts < 1:
        raise ValueError(f"`starts` must be 1 or above, but is {starts}.")
    samples = as_samples(data)
    if samples.value is None:
        raise ValueError(
            "Samples to fit must have values, but these come from a scene that has not "
            "been observed or rendered."
        )
    brdf = _model(model, samples.value.shape[1])
    residual = default_residual(data, residual)
    use = usable(samples, residual)
    brdf = _hold(brdf, fixed or {})
    check(brdf)
    layout = Layout.of(brdf)
    _require_data(use, layout, samples, residual)
    with jax.enable_x64(True):
        held = _held(layout, fixed or {})
        x0 = _starts(layout, brdf, starts, held, given=not isinstance(model, str))
        problem = bounded_problem(layout, brdf, residual, held)
        exact = problem(blocks=blocks(samples, use, residual, np.dtype(np.float64)))
        found = search(problem, exact, samples, use, x0, precision, max_steps)
        facts = examine(exact, found, held, int(use.sum()), samples.sigma is not None)
    return FitResult(
        brdf=_fitted(brdf, facts["parameters"]),
        model=registry_name(brdf),
        residual=residual.name,
        masked=int(use.size - use.sum()),
        starts=len(x0),
        path=_path(layout, residual, precision),
        seconds=time.perf_counter() - begin,
        data=samples.name,
        channels=samples.channels,
        **facts,
    )


def default_residual(
    data: Measurement | Samples, residual: str | Residual | None
) -> Residual:
    """The residual that is meant: by name, itself, or the default for the data.

    Reflectance spans decades and its noise is relative, so `log` is its default; the
    noise of images is closer to absolute, and a cosine is in them already.
    """
    if residual is None:
        return log if isinstance(data, Measurement) else cosine_weighted
    if isinstance(residual, str):
        return look_up(RESIDUALS, residual, "Residual")
    return residual


def _model(model: str | AbstractBRDF, channels: int) -> AbstractBRDF:
    if not isinstance(model, str):
        layout = Layout.of(model)
        if layout.channels != channels:
            raise ValueError(
                f"Model `{registry_name(model)}` must have the {channels} channels of "
                f"the data, but has {layout.channels}."
            )
        return model
    return from_name(model, channels)


def _hold(brdf: AbstractBRDF, fixed: Mapping) -> AbstractBRDF:
    current = values(brdf)
    for name in fixed:
        look_up(current, name, "Parameter")
    given = {name: jnp.asarray(value, float) for name, value in fixed.items()}
    for name, value in given.items():
        if value.size not in (1, current[name].size):
            raise ValueError(
                f"Parameter `{name}` of `{registry_name(brdf)}` must be held at "
                f"{current[name].size} numbers or one, but is given {value.size}."
            )
        given[name] = jnp.broadcast_to(value.squeeze(), current[name].shape)
    return replace(brdf, given)


def _require_data(use, layout: Layout, samples: Samples, residual: Residual) -> None:
    count, unknown = int(use.sum()), len(layout.labels)
    if count == 0:
        raise ValueError(
            f"Data `{samples.name}` must have at least one usable value under the "
            f"residual `{residual.name}`, but all {use.size} are masked, not finite, "
            f"unlit{' or not above 0' if residual.positive else ''}."
        )
    if count < unknown:
        raise ValueError(
            f"Data `{samples.name}` must have at least as many usable values as the "
            f"model has parameters ({unknown}), but has {count}."
        )


def _held(layout: Layout, fixed: Mapping) -> dict[int, float]:
    """Values of the fixed parameters, by place."""
    return {
        place: float(value)
        for name, given in fixed.items()
        for place, value in zip(
            layout.places[name],
            np.broadcast_to(given, len(layout.places[name])),
            strict=True,
        )
    }


def _starts(layout, brdf, count, held: Mapping[int, float], given: bool) -> np.ndarray:
    """Starting points; the first is the model's own when one was given."""
    spread = spread_starts(layout, max(count - given, 0))
    starts = np.concatenate([to_solver(layout, pack(brdf))[None], spread])[not given :]
    starts[:, list(held)] = _hold_at(layout, held)
    return starts


def bounded_problem(
    layout: Layout,
    brdf: AbstractBRDF,
    residual: Residual,
    held: Mapping[int, float],
) -> partial[Problem]:
    """A fit that lacks only its samples; the places ``held`` keep their values."""
    lower, upper = bounds(layout)
    lower[list(held)] = upper[list(held)] = _hold_at(layout, held)
    return partial(
        Problem,
        channels=channel_models(brdf),
        lower=jnp.asarray(lower),
        upper=jnp.asarray(upper),
        layout=layout,
        residual=residual,
    )


def _hold_at(layout: Layout, held: Mapping[int, float]) -> np.ndarray:
    natural = np.array([p.typical[0] for p in layout.known])
    natural[list(held)] = list(held.values())
    return to_solver(layout, natural)[list(held)]


def _fitted(brdf: AbstractBRDF, natural: Mapping[str, np.ndarray]) -> AbstractBRDF:
    """The model with the fitted values, in the precision JAX is set to."""
    return replace(brdf, {n: jnp.asarray(v, float) for n, v in natural.items()})


def _path(layout: Layout, residual: Residual, precision: str) -> str:
    basis = "per channel" if layout.separate else "shared by all channels"
    solved = (
        "linear parameters eliminated by variable projection"
        if residual.affine and layout.linear
        else "all parameters solved together from a streamed Jacobian"
    )
    return f"basis functions {basis}; {solved}; {precision}"
