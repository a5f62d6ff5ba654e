"""The small problem inside every step: a convex quadratic in a box."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

ROUNDS = 30
SHARES = 0.5 ** np.arange(8.0)  # of a Newton step, tried at once


def solve_positive(
    matrix: Float[Array, "n n"], right: Float[Array, " n"]
) -> Float[Array, " n"]:
    """Solve with a small positive definite matrix, which needs no pivots.

    Gauss-Jordan elimination in one short loop: a library call costs more to compile
    and, batched, more to run than the handful of numbers is worth.
    """

    def eliminate(k, system):
        row = system[k] / system[k, k]
        rest = system - jnp.outer(system[:, k], row)
        return jnp.where((jnp.arange(system.shape[0]) == k)[:, None], row, rest)

    system = jnp.concatenate([matrix, right[:, None]], axis=1)
    return jax.lax.fori_loop(0, matrix.shape[0], eliminate, system)[:, -1]


def minimise_in_box(
    hessian: Float[Array, "n n"],
    gradient: Float[Array, " n"],
    lower: Float[Array, " n"],
    upper: Float[Array, " n"],
) -> tuple[Float[Array, " n"], Bool[Array, " n"]]:
    r"""Minimise $\frac12 d^T H d + g^T d$ subject to $l \le d \le u$.

    Projected Newton (D. P. Bertsekas, SIAM J. Control Optim. 20(2), 1982): hold what a
    bound stops, take the Newton step in the rest, bent at the bounds, and shorten it
    until it pays. The cost never rises, and the answer is exact as soon as the right
    components are held.

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

    def unstopped(d, pull):
        return ~(((d <= low) & (pull > 0)) | ((d >= high) & (pull < 0)))

    def improve(state):
        rounds, _, free, d, pull = state
        both = free[:, None] & free[None, :]
        matrix = jnp.where(both, scaled, jnp.eye(size))
        newton = solve_positive(matrix, jnp.where(free, -pull, 0.0))
        trials = jax.vmap(lambda share: jnp.clip(d + share * newton, low, high))(SHARES)
        moved = trials - d[None]
        costs = moved @ pull + jnp.sum(moved * (moved @ scaled), axis=1) / 2
        best = jnp.argmin(costs)
        new = trials[best]
        pull = scaled @ new + slope
        now_free = unstopped(new, pull)
        exact = (best == 0) & jnp.all(new == d + newton) & jnp.all(now_free == free)
        stuck = costs[best] >= 0
        return rounds + 1, exact | stuck, now_free, new, pull

    start = jnp.clip(jnp.zeros(size), low, high)
    pull = scaled @ start + slope
    state = (0, jnp.array(False), unstopped(start, pull), start, pull)
    _, _, free, d, _ = jax.lax.while_loop(
        lambda state: (state[0] < ROUNDS) & ~state[1], improve, state
    )
    # a bound is met exactly, not up to the rounding of the scaling
    exact = jnp.where(d <= low, lower, jnp.where(d >= high, upper, d * unit))
    return exact, free
