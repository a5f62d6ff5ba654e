"""The small problem inside every step: a convex quadratic in a box."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

ROUNDS = 20


def minimise_in_box(
    hessian: Float[Array, "n n"],
    gradient: Float[Array, " n"],
    lower: Float[Array, " n"],
    upper: Float[Array, " n"],
) -> tuple[Float[Array, " n"], Bool[Array, " n"]]:
    r"""Minimise $\frac12 d^T H d + g^T d$ subject to $l \le d \le u$.

    Primal-dual active sets (M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13(3),
    2002): guess which bounds hold, solve for the rest, correct the guess. The answer is
    exact when the guess repeats; after `ROUNDS` rounds the last one, clipped, serves.

    Returns:
        The minimiser, and which components are free (not on a bound).
    """
    size = gradient.shape[0]
    diagonal = jnp.diagonal(hessian)
    unit = jnp.where(
        diagonal > 0, jax.lax.rsqrt(jnp.where(diagonal > 0, diagonal, 1)), 1
    )
    ridge = 8 * jnp.finfo(hessian.dtype).eps
    # at unit diagonal one tolerance serves all parameters
    scaled = hessian * unit[:, None] * unit[None, :] + ridge * jnp.eye(size)
    slope, low, high = gradient * unit, lower / unit, upper / unit

    def solve(free, at):
        matrix = jnp.where(free[:, None] & free[None, :], scaled, jnp.eye(size))
        fixed = jnp.where(free, 0.0, at)
        right = jnp.where(free, -slope - scaled @ fixed, at)
        return jnp.linalg.solve(matrix, right)

    def improve(state):
        round, _, free, d = state
        pull = -(scaled @ d + slope)  # the multiplier of a held bound
        aim = d + pull
        below, above = aim < low, aim > high
        at = jnp.where(below, low, jnp.where(above, high, 0.0))
        new_free = ~(below | above)
        return round + 1, jnp.all(new_free == free), new_free, solve(new_free, at)

    start = jnp.ones(size, bool)
    state = (0, jnp.array(False), start, solve(start, jnp.zeros(size)))
    _, _, free, d = jax.lax.while_loop(
        lambda state: (state[0] < ROUNDS) & ~state[1], improve, state
    )
    return jnp.clip(d, low, high) * unit, free
