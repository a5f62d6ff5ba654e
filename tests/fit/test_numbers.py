import math

import pytest

from brdffit.fit.numbers import rounded


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (0.363673, 0.0027748, ("0.3637", "0.0028")),
        (13.45, 0.0098, ("13.4500", "0.0098")),
        (471.463, 0.86, ("471.46", "0.86")),
        (1234.5, 152.0, ("1230", "150")),
        (0.0, 0.00035, ("0.00000", "0.00035")),
        (0.2, 1e-9, ("0.2", "1e-09")),
        (3.1e-7, 2e-8, ("3.1e-07", "2e-08")),
        (0.5, 0.0, ("0.5", "")),
        (0.84123, math.inf, ("0.841", "undetermined")),
    ],
)
def test_values_end_where_their_error_begins(value, error, shown):
    assert rounded(value, error) == shown
