import dataclasses

import jax
import numpy as np
import pytest

from brdffit.fit.blocks import AHEAD, SIZE, blocks, usable
from brdffit.fit.residual import cosine_weighted, log
from brdffit.samples import Measurement, as_samples


@pytest.fixture(autouse=True)
def double():
    """As a fit does, lay samples out in double precision."""
    with jax.enable_x64(True):
        yield


def samples(count=5, **changes):
    """Directions above the horizon with rising values."""
    w = np.tile([[0.6, 0.0, 0.8]], (count, 1))
    f_r = np.linspace(0.1, 0.5, count)[:, None] * np.ones(2)
    return as_samples(Measurement(**({"wi": w, "wo": w, "f_r": f_r} | changes)))


def test_what_cannot_be_used_is_left_out():
    w = np.array([[0.6, 0, 0.8], [0.6, 0, 0.8], [0.6, 0, 0.8], [0.6, 0, -0.8]])
    f_r = np.array([[0.1, np.nan], [-0.1, 0.2], [0.3, 0.0], [0.4, 0.4]])
    up = np.tile([[0.0, 0.0, 1.0]], (4, 1))
    data = samples(wi=w, wo=up, f_r=f_r)
    expected = [[True, False], [True, True], [True, True], [False, False]]
    np.testing.assert_array_equal(usable(data, cosine_weighted), expected)
    expected = [[True, False], [False, True], [True, False], [False, False]]
    np.testing.assert_array_equal(usable(data, log), expected)


def test_padding_has_no_weight_and_harmless_directions():
    data = samples()
    laid = blocks(data, usable(data, log), log, np.dtype(float))
    assert laid.lights.wi.shape == (1, 3, SIZE)
    assert laid.count == 1
    assert np.all(laid.scale[..., 5:] == 0)
    np.testing.assert_allclose(np.linalg.norm(laid.lights.wi[0], axis=0), 1)
    np.testing.assert_array_equal(laid.value[0, :, :5], np.asarray(data.value).T)


def test_known_errors_are_carried_through_the_transform():
    """The error of a logarithm is the relative error."""
    data = samples(sigma=np.full((5, 2), 0.01))
    laid = blocks(data, usable(data, log), log, np.dtype(float))
    np.testing.assert_allclose(laid.scale[0, 0, :5], laid.value[0, 0, :5] / 0.01)
    np.testing.assert_allclose(laid.lean[0, :, :5], 1 / 0.01)


def test_weights_follow_the_solid_angle():
    data = dataclasses.replace(samples(), solid_angle=np.array([1.0, 1, 1, 1, 4]))
    laid = blocks(data, usable(data, log), log, np.dtype(float))
    assert laid.scale[0, 0, 4] == pytest.approx(2 * laid.scale[0, 0, 0])


@pytest.mark.parametrize(("count", "room"), [(1, 1), (2048, 1), (2049, 4), (9000, 16)])
def test_few_sizes_serve_all_counts(count, room):
    data = samples(count)
    assert blocks(data, usable(data, log), log, np.dtype(float)).wo.shape[0] == room


def test_the_first_blocks_stand_for_all():
    """The brightest are among them, and no row is lost or met twice."""
    data = samples(20_000)
    laid = blocks(data, usable(data, log), log, np.dtype(float))
    values = laid.value[:, 0].ravel()[:20_000]
    np.testing.assert_array_equal(np.sort(values), np.asarray(data.value)[:, 0])
    first = values[: AHEAD * SIZE]
    assert first.max() > np.quantile(values, 0.999)
    assert np.mean(first > np.quantile(values, 0.95)) == pytest.approx(0.25, abs=0.03)
    assert np.median(first) == pytest.approx(np.median(values), rel=0.2)
