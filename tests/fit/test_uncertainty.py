import numpy as np
import pytest

from brdffit.fit.uncertainty import uncertainty


def errors(hessian, natural=(1.0, 2.0, 3.0), variance=0.01, **changes):
    size = len(hessian)
    arguments = {
        "hessian": np.array(hessian, float),
        "natural": np.array(natural[:size]),
        "slopes": np.ones(size),
        "widths": np.full(size, 10.0),
        "fixed": np.zeros(size, bool),
        "at_bound": np.zeros(size, bool),
        "variance": variance,
        "labels": ("a", "b", "c")[:size],
    }
    return uncertainty(**arguments | changes)


def test_errors_are_those_of_the_inverse():
    hessian = np.array([[4.0, 1.0], [1.0, 9.0]])
    found = errors(hessian)
    covariance = 0.01 * np.linalg.inv(hessian)
    np.testing.assert_allclose(found.standard_errors, np.sqrt(np.diag(covariance)))
    expected = covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])
    assert found.correlation[0, 1] == pytest.approx(expected)
    assert found.undetermined == {}


def test_a_parameter_on_its_bound_does_not_widen_the_others():
    hessian = np.array([[4.0, 3.0], [3.0, 9.0]])
    found = errors(hessian, at_bound=np.array([False, True]))
    assert found.standard_errors[0] == pytest.approx(0.1 / 2)
    free = errors(hessian)
    assert found.standard_errors[1] == pytest.approx(free.standard_errors[1])


def test_a_product_is_told_from_its_factors():
    """r = a b + c: only the product is seen."""
    a, b = 1.0, 2.0
    jacobian = np.array([[b, a, 0.0], [0.0, 0.0, 1.0], [b, a, 1.0]])
    found = errors(jacobian.T @ jacobian)
    assert set(found.undetermined) == {"a", "b"}
    assert np.isinf(found.standard_errors[:2]).all()
    assert np.isfinite(found.standard_errors[2])
    sentence = found.undetermined["a"]
    assert "`a` and `b` cannot be told apart" in sentence.replace(
        "`b` and `a`", "`a` and `b`"
    )
    assert "by 10 % is undone by lowering" in sentence


def test_a_parameter_without_effect_is_named():
    found = errors([[4.0, 0.0], [0.0, 0.0]])
    assert found.undetermined == {"b": "`b` has no effect on these data."}


def test_noise_can_hide_a_parameter():
    """Known no better than its legal interval already says."""
    found = errors([[4.0, 0.0], [0.0, 1e-4]], variance=1.0)
    assert "as wide as its legal interval" in found.undetermined["b"]


def test_without_bounds_noise_hides_nothing():
    found = errors([[4.0, 0.0], [0.0, 1e-4]], variance=1.0, widths=np.full(2, np.inf))
    assert found.undetermined == {}


def test_what_drifts_along_a_lost_direction_is_not_called_sure():
    """r = a + b / 50: b takes too small a part in the lost direction to be named."""
    jacobian = np.array([[1.0, 50.0], [1.0, 50.0]])
    found = errors(jacobian.T @ jacobian, variance=1e-12)
    assert "b" not in found.undetermined
    assert np.isinf(found.standard_errors[0])
    # a may be anywhere within its interval of 10, and b a fiftieth of that
    assert found.standard_errors[1] == pytest.approx(0.3 * 10 / 50, rel=0.01)
