"""What a model leaves unexplained, value by value."""

import jax.numpy as jnp
import numpy as np

from brdffit.fit.blocks import usable
from brdffit.fit.residual import Residual
from brdffit.models import AbstractBRDF
from brdffit.render.shading import compiled_shade
from brdffit.samples import Samples


def misfit(brdf: AbstractBRDF, samples: Samples, residual: Residual) -> np.ndarray:
    """``T(fitted) - T(measured)``, shape ``(N, C)``, NaN where a value is not used."""
    use = usable(samples, residual)
    transform = residual.on(samples)
    measured = jnp.asarray(np.where(use, np.asarray(samples.value), 1.0))
    fitted = jnp.asarray(compiled_shade(brdf, samples))
    return np.where(use, np.asarray(transform(fitted) - transform(measured)), np.nan)
