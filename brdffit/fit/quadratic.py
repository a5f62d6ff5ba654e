"""The small problem inside every step: a convex quadratic in a box."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

ROUNDS = 20


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
        return solve_positive(matrix, jnp.where(free, -slope - scaled @ fixed, at))

    def improve(state):
        rounds, _, free, at, _ = state
        d = solve(free, at)
        aim = d - (scaled @ d + slope)  # plus the multiplier of a held bound
        below, above = aim < low, aim > high
        guess = ~(below | above)
        at = jnp.where(below, low, jnp.where(above, high, 0.0))
        return rounds + 1, jnp.all(guess == free), guess, at, d

    nothing = jnp.zeros(size)
    _, _, free, _, d = jax.lax.while_loop(
        lambda state: (state[0] < ROUNDS) & ~state[1],
        improve,
        (0, jnp.array(False), jnp.ones(size, bool), nothing, nothing),
    )
    return jnp.clip(d, low, high) * unit, free
