"""What a solution costs under every residual."""

import jax
import jax.numpy as jnp
from jaxtyping import Array

from brdffit.fit.basis import Problem, over_blocks, predicted, transform_in
from brdffit.fit.residual import Residual


def costs(problem: Problem, x: Array, residuals: tuple[Residual, ...]) -> Array:
    """How far off the parameters are under each residual.

    Values that a residual cannot compare are left out of its sums.

    Returns:
        ``(residual, 3)``: half the weighted sum of squares; the sum of squares in
        which values weigh as their solid angle alone, and the sum of those weights.
    """

    def add(block):
        value = predicted(problem, x, block)
        base = block.lean if block.known_sigma else block.scale
        share = 1 if block.share is None else block.share
        found = []
        for residual in residuals:
            transform = transform_in(block, residual)
            one = jnp.ones_like(block.value)
            target, slope = jax.jvp(transform, (block.value,), (one,))
            use = jnp.broadcast_to(base > 0, value.shape) & (slope > 0)
            if residual.positive:
                use &= block.value > 0
            error = jnp.where(use, transform(value) - target, 0)
            scale = base / jnp.where(use, slope, 1) if block.known_sigma else base
            square = jnp.sum((error * scale) ** 2) / 2
            weight = jnp.where(use, share**2, 0)
            tally = square, jnp.sum(weight * error**2), jnp.sum(weight)
            found.append(jnp.stack(tally))
        return jnp.stack(found)

    return over_blocks(problem, add, jnp.zeros((len(residuals), 3), jnp.float64))
