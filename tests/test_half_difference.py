import numpy as np
import pytest

from brdffit import half_difference


@pytest.fixture(scope="module")
def some():
    wi, wo, _ = half_difference.cells()
    rows = np.random.default_rng(0).integers(0, len(wi), 2000)
    return rows, wi[rows], wo[rows]


def test_the_centre_of_a_cell_lies_in_it(some):
    rows, wi, wo = some
    assert np.array_equal(half_difference.cell_of(wi, wo), rows)


def test_exchanged_directions_share_a_cell(some):
    rows, wi, wo = some
    assert np.array_equal(half_difference.cell_of(wo, wi), rows)


def test_a_surface_that_is_turned_keeps_its_cells(some):
    rows, wi, wo = some
    turn = np.random.default_rng(1).uniform(0, 2 * np.pi, len(rows))
    cosine, sine = np.cos(turn), np.sin(turn)

    def turned(w):
        x, y, z = w.T
        return np.stack([x * cosine - y * sine, x * sine + y * cosine, z], axis=1)

    assert np.array_equal(half_difference.cell_of(turned(wi), turned(wo)), rows)


def test_the_normal_lies_in_the_first_cell():
    up = np.array([[0.0, 0.0, 1.0]])
    assert half_difference.cell_of(up, up) // 180 == 0
