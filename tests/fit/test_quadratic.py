import itertools

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.fit.quadratic import minimise_in_box, minimise_in_boxes, solve_positive


def by_enumeration(hessian, gradient, lower, upper):
    """Every choice of free and held components; the best feasible one."""
    best, best_value = None, np.inf
    for choice in itertools.product((None, lower, upper), repeat=len(gradient)):
        held = np.array([c is not None for c in choice])
        d = np.array([0.0 if c is None else c[i] for i, c in enumerate(choice)])
        free = ~held
        if free.any():
            right = -(gradient + hessian @ d)[free]
            d[free] = np.linalg.solve(hessian[np.ix_(free, free)], right)
        value = d @ hessian @ d / 2 + gradient @ d
        inside = np.all((d >= lower - 1e-12) & (d <= upper + 1e-12))
        if inside and value < best_value:
            best, best_value = d, value
    return best


@pytest.mark.parametrize("size", [1, 2, 4])
def test_minimum_in_a_box_is_that_of_an_exhaustive_search(size):
    rng = np.random.default_rng(size)
    with jax.enable_x64(True):
        solve = jax.jit(minimise_in_box)
        for _ in range(40):
            root = rng.normal(size=(size + 2, size))
            hessian, gradient = root.T @ root, 2 * rng.normal(size=size)
            lower, upper = -rng.uniform(0, 1, size), rng.uniform(0, 1, size)
            found, free = solve(*map(jnp.asarray, (hessian, gradient, lower, upper)))
            truth = by_enumeration(hessian, gradient, lower, upper)
            np.testing.assert_allclose(found, truth, atol=1e-9)
            np.testing.assert_array_equal(free, (truth > lower) & (truth < upper))


def test_a_component_with_equal_bounds_does_not_move():
    with jax.enable_x64(True):
        found, _ = minimise_in_box(
            jnp.eye(2), jnp.array([-1.0, -1.0]), jnp.array([0.0, -5.0]), jnp.zeros(2)
        )
    np.testing.assert_array_equal(found, 0)


def test_elimination_solves_a_positive_system():
    root = np.random.default_rng(0).normal(size=(9, 6))
    right = np.arange(6.0)
    with jax.enable_x64(True):
        found = solve_positive(jnp.asarray(root.T @ root), jnp.asarray(right))
    np.testing.assert_allclose(root.T @ root @ np.asarray(found), right, atol=1e-11)


@pytest.mark.parametrize("size", [1, 2, 3])
def test_many_boxes_at_once_agree_with_one_at_a_time(size):
    rng = np.random.default_rng(2)
    factors = rng.standard_normal((size, size + 2, 50))
    hessian = np.einsum("iot,jot->ijt", factors, factors)
    gradient = rng.standard_normal((size, 50))
    lower, upper = -rng.uniform(0, 0.5, (size, 50)), rng.uniform(0, 0.5, (size, 50))
    with jax.enable_x64(True):
        problems = tuple(map(jnp.asarray, (hessian, gradient, lower, upper)))
        many, free = jax.jit(minimise_in_boxes)(*problems)
        one, expected = jax.jit(jax.vmap(minimise_in_box, -1, -1))(*problems)
    np.testing.assert_allclose(many, one, atol=1e-10)
    np.testing.assert_array_equal(free, expected)
    many, free = np.asarray(many), np.asarray(free)
    assert np.all(((many == lower) | (many == upper)) == ~free)  # to the last digit
