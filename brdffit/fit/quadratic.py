"""The small problem inside every step: a convex quadratic in a box."""

import functools
import operator

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

ROUNDS = 30
SHARES = 0.5 ** np.arange(8.0)  # of a Newton step, tried at once


def solve_positive(
    matrix: Float[Array, "n n *many"], right: Float[Array, " n *many"]
) -> Float[Array, " n *many"]:
    """Solve with a small positive definite matrix, which needs no pivots.

    Gauss-Jordan elimination in one short loop: a library call costs more to compile
    and, batched, more to run than the handful of numbers is worth.
    """
    places = jnp.arange(matrix.shape[0]).reshape(-1, *[1] * right.ndim)

    def eliminate(k, system):
        row = (system[k] / system[k, k][None])[None]
        return jnp.where(places == k, row, system - system[:, k, None] * row)

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


def minimise_in_boxes(
    hessian: Float[Array, "n n *many"],
    gradient: Float[Array, " n *many"],
    lower: Float[Array, " n *many"],
    upper: Float[Array, " n *many"],
) -> tuple[Float[Array, " n *many"], Bool[Array, " n *many"]]:
    """`minimise_in_box` for many small problems at once, by elementwise operations.

    Block principal pivoting (J. J. Judice and F. M. Pires, Computers & Operations
    Research 21(5), 1994): solve with some components on their bounds, then change the
    side of all that are on the wrong one; after some rounds of only the first of them,
    which is sure to end (K. G. Murty, Linear Algebra and its Applications 7(1), 1974).

    Returns:
        The minimisers, and which components are free (not on a bound).
    """
    size = gradient.shape[0]
    if size == 0:
        return gradient, jnp.zeros(gradient.shape, bool)
    eps = jnp.finfo(hessian.dtype).eps
    eye = jnp.eye(size, dtype=hessian.dtype)
    eye = eye.reshape(size, size, *[1] * (gradient.ndim - 1))
    diagonal = jnp.stack([hessian[i, i] for i in range(size)])
    unit = jnp.where(
        diagonal > 0, jax.lax.rsqrt(jnp.where(diagonal > 0, diagonal, 1)), 1
    )
    scaled = hessian * unit[:, None] * unit[None] + 8 * eps * eye
    slope, low, high = gradient * unit, lower / unit, upper / unit
    if size == 1:
        d = -slope / scaled[0]
        return _on_bounds(d <= low, d >= high, d * unit, lower, upper)
    if size == 2:
        d = _in_rectangle(scaled, slope, low, high)
        return _on_bounds(d <= low, d >= high, d * unit, lower, upper)

    def exchange(state):
        rounds, _, side, _ = state
        free = side == 0
        held = jnp.where(free, 0, jnp.where(side < 0, low, high))
        matrix = jnp.where(free[:, None] & free[None], scaled, eye)
        right = jnp.where(free, -slope - _times(scaled, held), held)
        d = _solve_positive_unrolled(matrix, right)
        pull = _times(scaled, d) + slope
        near = 8 * eps * jnp.abs(d)
        small = 8 * eps * (_times(jnp.abs(scaled), jnp.abs(d)) + jnp.abs(slope))
        below, above = free & (d < low - near), free & (d > high + near)
        loose = ((side < 0) & (pull < -small)) | ((side > 0) & (pull > small))
        wrong = below | above | (loose & (low < high))
        change = wrong & (_first(wrong) | (rounds < size))
        belongs = above.astype(side.dtype) - below.astype(side.dtype)
        return rounds + 1, jnp.any(wrong), jnp.where(change, belongs, side), d

    side = jnp.where(low < high, 0, -1).astype(jnp.int8)
    state = (0, jnp.array(True), side, gradient)
    _, _, side, d = jax.lax.while_loop(
        lambda state: (state[0] < ROUNDS) & state[1], exchange, state
    )
    below, above = (side < 0) | (d <= low), (side > 0) | (d >= high)
    return _on_bounds(below, above, d * unit, lower, upper)


def _in_rectangle(hessian: Array, slope: Array, low: Array, high: Array) -> Array:
    """The minimiser of two unknowns within their bounds.

    That of the plane if it lies within; or else the best of the four sides has it.
    """
    (a, b), (_, c) = hessian
    (u, v), (left, lowest), (right, highest) = slope, low, high
    determinant = a * c - b * b
    x, y = (b * v - c * u) / determinant, (b * u - a * v) / determinant
    inside = (left <= x) & (x <= right) & (lowest <= y) & (y <= highest)
    sides = [
        (end, jnp.clip(-(v + b * end) / c, lowest, highest)) for end in (left, right)
    ]
    sides += [
        (jnp.clip(-(u + b * end) / a, left, right), end) for end in (lowest, highest)
    ]
    least = jnp.where(inside, -jnp.inf, jnp.inf)
    for p, q in sides:
        cost = p * (a * p / 2 + b * q + u) + q * (c * q / 2 + v)
        better = cost < least  # False at an infinite end
        x, y, least = (
            jnp.where(better, new, old) for new, old in ((p, x), (q, y), (cost, least))
        )
    return jnp.stack([x, y])


def _on_bounds(below, above, d, lower, upper) -> tuple[Array, Array]:
    """Components exactly on their bounds, and which are not on one."""
    return jnp.where(below, lower, jnp.where(above, upper, d)), ~(below | above)


def _times(matrix: Array, vector: Array) -> Array:
    """Products of small matrices and vectors, term by term."""
    terms = [matrix[:, j] * vector[j][None] for j in range(vector.shape[0])]
    return functools.reduce(operator.add, terms)


def _first(flags: Array) -> Array:
    """Only the first of the flags that are set."""
    seen, first = jnp.zeros(flags.shape[1:], bool), []
    for flag in flags:
        first.append(flag & ~seen)
        seen |= flag
    return jnp.stack(first)


def _solve_positive_unrolled(matrix: Array, right: Array) -> Array:
    """`solve_positive` without a loop, for many systems: its steps become one."""
    size = right.shape[0]
    system = jnp.concatenate([matrix, right[:, None]], axis=1)
    rows = [system[i] for i in range(size)]
    for k in range(size):
        rows[k] = rows[k] / rows[k][k][None]
        rows = [r if i == k else r - r[k][None] * rows[k] for i, r in enumerate(rows)]
    return jnp.stack([row[-1] for row in rows])
