"""What the parameters would be had the noise fallen otherwise."""

import dataclasses
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.fit.blocks import usable
from brdffit.fit.fit import default_residual, fit
from brdffit.fit.misfit import misfit
from brdffit.fit.result import FitResult
from brdffit.models import AbstractBRDF
from brdffit.render.shading import compiled_shade
from brdffit.samples import Measurement, Samples, as_samples

INSIDE = (0.025, 0.975)  # quantiles that hold 95 %


@dataclasses.dataclass(frozen=True)
class Bootstrap:
    """Fits to data made anew.

    Attributes:
        parameters: Values by name, with a leading axis of resamples.
        standard_errors: Their standard deviations, by name.
        intervals: Their 2.5 % and 97.5 % quantiles by name, along a leading axis.
        result: The fit to the data as they are.
    """

    parameters: dict[str, np.ndarray]
    standard_errors: dict[str, np.ndarray]
    intervals: dict[str, np.ndarray]
    result: FitResult

    def to_dict(self) -> dict[str, Any]:
        """Errors and intervals in types that JSON knows, without the fits."""
        return {
            "resamples": len(next(iter(self.parameters.values()))),
            "standard_errors": {n: v.tolist() for n, v in self.standard_errors.items()},
            "intervals": {n: v.tolist() for n, v in self.intervals.items()},
        }


def bootstrap(
    model: str | AbstractBRDF,
    data: Measurement | Samples,
    *,
    resamples: int = 100,
    seed: int = 0,
    **options: Any,
) -> Bootstrap:
    """Residual bootstrap of a fit.

    Each resample adds residuals of the fit, drawn with replacement, to its predictions,
    in the quantity that the residual compares and in units of the known errors, if
    there are any; and is fitted like the data.

    Args:
        model: As for `fit`.
        data: As for `fit`.
        resamples: Number of data sets to make, 2 or more.
        seed: Of the draws.
        options: Further options of `fit`.

    Source:
        B. Efron and R. Tibshirani, "An Introduction to the Bootstrap", 1993, chapter 9.

    Raises:
        ValueError: As for `fit`, or too few resamples.
    """
    if resamples < 2:
        raise ValueError(f"`resamples` must be 2 or above, but is {resamples}.")
    result = fit(model, data, **options)
    samples = as_samples(data)
    residual = default_residual(data, options.pop("residual", None))
    use = usable(samples, residual)
    transform = residual.on(samples)
    fitted = jnp.asarray(compiled_shade(result.brdf, samples))
    unit = np.ones(use.shape)
    if samples.sigma is not None:
        slope = jax.jvp(transform, (fitted,), (jnp.ones_like(fitted),))[1]
        unit = np.where(use, samples.sigma * np.asarray(slope), 1)
    errors = misfit(result.brdf, samples, residual) / unit
    pool = errors[use] - np.mean(errors[use])
    cosines = jnp.asarray(samples.cosine)[:, None], jnp.asarray(samples.wo)[:, 2:]
    predicted, draw = np.asarray(transform(fitted)), np.random.default_rng(seed)
    found = []
    for _ in range(resamples):
        compared = predicted - unit * draw.choice(pool, use.shape)
        value = np.asarray(residual.inverse(jnp.asarray(compared), *cosines))
        anew = dataclasses.replace(samples, value=value, mask=use)
        found.append(fit(model, anew, residual=residual, **options).parameters)
    drawn = {name: np.array([f[name] for f in found]) for name in result.parameters}
    return Bootstrap(
        parameters=drawn,
        standard_errors={n: np.std(v, axis=0, ddof=1) for n, v in drawn.items()},
        intervals={n: np.quantile(v, INSIDE, axis=0) for n, v in drawn.items()},
        result=result,
    )
