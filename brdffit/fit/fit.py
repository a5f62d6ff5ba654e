"""One fit, from samples to a result."""

import dataclasses
import time
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.catalogue import from_name
from brdffit.fit.basis import Problem
from brdffit.fit.blocks import blocks, usable
from brdffit.fit.conditions import (
    Numbers,
    Prior,
    bounded_problem,
    held_values,
    hold_at,
    priors_of,
)
from brdffit.fit.examine import examine
from brdffit.fit.loss import LOSSES, Loss
from brdffit.fit.misfit import misfit
from brdffit.fit.plain import residual_vector, search_plainly
from brdffit.fit.residual import RESIDUALS, Residual, cosine_weighted, log
from brdffit.fit.result import FitResult
from brdffit.fit.robust import spread_of
from brdffit.fit.search import RTOL, Search, search
from brdffit.fit.start import starts as starts_of, typical_box
from brdffit.fit.transforms import (
    Layout,
    pack,
    to_natural,
    unpack,
)
from brdffit.models import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import as_float, check, registry_name
from brdffit.samples import Measurement, Samples, as_samples

if TYPE_CHECKING:
    import optimistix

MAX_STEPS = 200
ROUNDS = 2  # of finding the noise and fitting again, where a fit must know it


def fit(
    model: str | AbstractBRDF,
    data: Measurement | Samples,
    *,
    residual: str | Residual | None = None,
    loss: str | Loss | None = None,
    starts: int = 16,
    fixed: Mapping[str, Numbers] | None = None,
    tied: Sequence[str] = (),
    per_channel: Sequence[str] = (),
    priors: Mapping[str, Prior] | None = None,
    precision: str = "float64",
    solver: Optional["optimistix.AbstractLeastSquaresSolver"] = None,
    max_steps: int = MAX_STEPS,
) -> FitResult:
    """Fit the parameters of a model to measured or simulated reflectance.

    Args:
        model: Name of a model, or of a sum such as ``ggx+ggx_lobe``, which takes the
            channels of the data; or a model, whose values are one more start.
        data: What to explain.
        residual: Comparison whose squares are minimised, by name or itself; by default
            `log` for reflectance and `cosine_weighted` for images.
        loss: ``"huber"`` or ``"cauchy"``, which keep outliers from leading the fit; by
            default every square counts in full. Outliers are told by the known errors
            of the data, or else by the spread of most of the residuals.
        starts: Number of starts: one at the lobe of the data, the others spread over
            the typical ranges of the parameters.
        fixed: Parameters to hold, with their values.
        tied: Spectral parameters to give one value in all channels.
        per_channel: Shared parameters to give a value in each channel.
        priors: Mean and standard deviation of what is known of parameters beforehand,
            by name. They weigh against the known errors of the data, or else against
            the noise that a fit without them leaves.
        precision: ``"float64"`` or ``"float32"``: that in which models are evaluated.
            Sums are always double, and so are the errors and costs reported.
        solver: A least-squares solver of optimistix, to take instead of the one that
            uses the structure of the model; slower, and without loss or priors.
        max_steps: Number of steps after which a start gives up.

    Returns:
        The best of all starts. A solver that stopped early raises nothing: see
        ``converged`` and ``status``.

    Raises:
        ValueError: An unknown name, a parameter outside its interval, channels that do
            not match, or no usable sample; a sentence says which.
    """
    begin = time.perf_counter()
    _require_options(precision, starts, solver is not None and bool(loss or priors))
    samples = as_samples(data)
    if samples.value is None:
        raise ValueError(
            "Samples to fit must have values, but these come from a scene that has not "
            "been observed or rendered."
        )
    brdf = _model(model, samples.value.shape[1])
    check(brdf)
    residual = default_residual(data, residual)
    loss = look_up(LOSSES, loss, "Loss") if isinstance(loss, str) else loss
    layout = Layout.of(brdf, tied, per_channel)
    held = held_values(layout, fixed or {}, registry_name(brdf))
    prior = priors_of(layout, priors or {})
    use = usable(samples, residual)
    _require_data(use, layout, samples, residual)
    known_sigma = samples.sigma is not None
    with jax.enable_x64(True):
        own = None if isinstance(model, str) else pack(layout, brdf)
        x0 = starts_of(layout, samples, use, starts, own)
        x0[:, list(held)] = hold_at(layout, held)
        problem = bounded_problem(layout, brdf, residual, held)
        exact = problem(blocks=blocks(samples, use, residual, np.dtype(np.float64)))
        quick = exact
        if precision != "float64":
            quick = problem(blocks=blocks(samples, use, residual, np.dtype(precision)))
        if solver is not None:
            residuals = residual_vector(layout, brdf, samples, use, residual)
            middle = np.mean(typical_box(layout), axis=0)
            x0 = np.where(np.isnan(x0), middle, x0)
            found = search_plainly(residuals, exact, x0, solver, max_steps)
        else:
            found = search(quick, x0, RTOL[precision], max_steps)
        for _ in range(ROUNDS if loss or priors else 0):
            spread = _spread(found, layout, brdf, samples, use, residual, loss)
            asked = {
                "loss": loss,
                "spread": np.asarray(spread),
                "prior_mean": prior[0],
                "prior_weight": prior[1] * spread**2,
            }
            exact, quick = (dataclasses.replace(p, **asked) for p in (exact, quick))
            again = np.concatenate([found.x[None], x0])[:starts]
            found = search(quick, again, RTOL[precision], max_steps)
            if known_sigma:
                break
        facts = examine(exact, found, held, int(use.sum()), known_sigma)
    return FitResult(
        brdf=_fitted(layout, brdf, facts["parameters"]),
        model=registry_name(brdf),
        residual=residual.name,
        loss=loss and loss.name,
        masked=int(use.size - use.sum()),
        starts=len(x0),
        path=_path(exact, precision, solver),
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


def _require_options(precision: str, starts: int, lost: bool) -> None:
    if precision not in RTOL:
        raise ValueError(
            f"Precision must be `float64` or `float32`, but is `{precision}`."
        )
    if starts < 1:
        raise ValueError(f"`starts` must be 1 or above, but is {starts}.")
    if lost:
        raise ValueError(
            "A `solver` of optimistix must be asked for without `loss` and `priors`, "
            "which only the solver of brdffit knows."
        )


def _model(model: str | AbstractBRDF, channels: int) -> AbstractBRDF:
    if not isinstance(model, str):
        if model.channels != channels:
            raise ValueError(
                f"Model `{registry_name(model)}` must have the {channels} channels of "
                f"the data, but has {model.channels}."
            )
        return model
    return from_name(model, channels)


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


def _spread(
    found: Search, layout, brdf, samples, use, residual, loss: Loss | None
) -> float:
    """Standard deviation of a residual of unit weight: 1 when errors are known."""
    if samples.sigma is not None:
        return 1.0
    if loss is None:
        unknown = len(layout.labels)
        return float(np.sqrt(2 * found.cost / max(use.sum() - unknown, 1)))
    places = tuple(range(len(layout.labels)))
    natural = to_natural(layout, jnp.asarray(found.x), places)
    return spread_of(misfit(unpack(layout, brdf, natural), samples, residual))


def _fitted(
    layout: Layout, brdf: AbstractBRDF, natural: Mapping[str, Any]
) -> AbstractBRDF:
    """The model with the fitted values, in the precision JAX is set to."""
    flat = np.concatenate([np.atleast_1d(v) for v in natural.values()])
    held = unpack(layout, brdf, flat)
    return jax.tree.map(lambda leaf: as_float(np.asarray(leaf, float)), held)


def _path(
    problem: Problem,
    precision: str,
    solver: Optional["optimistix.AbstractLeastSquaresSolver"],
) -> str:
    layout = problem.layout
    if solver is not None:
        return f"plain vector of residuals; {type(solver).__name__}; float64"
    basis = "per channel" if layout.separate else "shared by all channels"
    solved = (
        "linear parameters eliminated by variable projection"
        if problem.projected and layout.linear
        else "all parameters solved together from a streamed Jacobian"
    )
    return f"basis functions {basis}; {solved}; {precision}"
