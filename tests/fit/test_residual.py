import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.fit.residual import RESIDUALS

VALUE, COS_I, COS_O = 0.3, 0.8, 0.5
BY_HAND = {
    "plain": VALUE,
    "cosine_weighted": VALUE * COS_I,
    "log": np.log(VALUE),
    "log_cosine": np.log(1 + VALUE * COS_I),
    "cube_root": (VALUE * COS_I) ** (1 / 3),
    "log_relative": np.log(VALUE * COS_I * COS_O + 1e-3),
}


@pytest.mark.parametrize("name", RESIDUALS)
def test_transform_is_the_formula(name):
    found = RESIDUALS[name].transform(*map(jnp.asarray, (VALUE, COS_I, COS_O)))
    np.testing.assert_allclose(found, BY_HAND[name], rtol=1e-6)


@pytest.mark.parametrize("name", RESIDUALS)
def test_affine_is_declared_where_it_holds(name):
    low, middle, high = (
        RESIDUALS[name].transform(jnp.asarray(v), jnp.asarray(0.7), jnp.asarray(0.6))
        for v in (0.1, 0.5, 0.9)
    )
    affine = bool(jnp.isclose(middle, (low + high) / 2, rtol=1e-5))
    assert affine == RESIDUALS[name].affine


@pytest.mark.parametrize("name", RESIDUALS)
def test_the_inverse_gives_the_value_back(name):
    value, cos_i, cos_o = jnp.array([0.01, 0.3, 7.0]), jnp.array(0.8), jnp.array(0.5)
    residual = RESIDUALS[name]
    compared = residual.transform(value, cos_i, cos_o)
    np.testing.assert_allclose(residual.inverse(compared, cos_i, cos_o), value, 2e-5)
