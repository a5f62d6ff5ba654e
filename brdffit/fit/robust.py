r"""What a robust loss needs to know of the noise, and leaves of it.

Outliers are told from the spread of the many: $s = 1.4826$ times the median magnitude
of the residuals, which is the standard deviation of normal noise and which outliers
hardly move. At the solution of a loss with $\psi(u) = u\,\rho'(u^2)$ the covariance is

$$ s^2 \frac{\overline{\psi^2}}{\overline{\psi'}^2} (J^T J)^{-1} $$

(P. Huber, "Robust Statistics", 1981, section 7.6).
"""

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.compiled import compiled
from brdffit.fit.basis import Problem, over_blocks, predicted, transform_in
from brdffit.fit.loss import Loss

OF_NORMAL = 1.4826  # standard deviation of normal noise, in median magnitudes


def spread_of(errors: np.ndarray) -> float:
    """Standard deviation of most of the errors; those that are NaN are left out."""
    return float(OF_NORMAL * np.nanmedian(np.abs(errors)))


@compiled
def inflation(problem: Problem, x) -> jax.Array:
    """Variance of the loss's solution, in that of least squares on unit normal noise.

    Weighted by the share of the solid angle, as the fit is.
    """
    loss = problem.loss
    assert isinstance(loss, Loss)  # for the type checker

    def psi(u):
        return u * loss.weight(u * u)

    def add(block):
        transform = transform_in(block, problem.residual)
        error = transform(predicted(problem, x, block)) - block.target
        share = jnp.broadcast_to(block.used_share(), error.shape)
        u = error * block.scale / jnp.where(share > 0, share, 1) / problem.spread
        value, slope = jax.jvp(psi, (u,), (jnp.ones_like(u),))
        return jnp.stack([jnp.sum(share**2 * f) for f in (value**2, slope, share > 0)])

    square, slope, count = over_blocks(problem, add, jnp.zeros(3))
    return square / count / (slope / count) ** 2
