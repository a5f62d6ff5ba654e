import numpy as np
import pytest

from brdffit.fit.start import spread_starts
from brdffit.fit.transforms import Layout, bounds, to_solver
from brdffit.models import MODELS


@pytest.mark.parametrize("name", MODELS)
def test_starts_lie_in_the_typical_ranges_and_differ(name):
    layout = Layout.of(MODELS[name]())
    starts = spread_starts(layout, 16)
    low = to_solver(layout, np.array([p.typical[0] for p in layout.known]))
    high = to_solver(layout, np.array([p.typical[1] for p in layout.known]))
    assert np.all((starts >= low) & (starts <= high))
    for parameter in layout.nonlinear:
        column = starts[:, layout.places[parameter][0]]
        assert len(np.unique(column)) == 16
        # evenly: no gap as wide as a quarter of the range
        place = layout.places[parameter][0]
        edges = np.concatenate([[low[place]], np.sort(column), [high[place]]])
        assert np.diff(edges).max() < 0.25 * (high - low)[place]


@pytest.mark.parametrize("name", MODELS)
def test_typical_ranges_lie_within_the_legal_ones(name):
    layout = Layout.of(MODELS[name]())
    lower, upper = bounds(layout)
    starts = spread_starts(layout, 4)
    assert np.all((starts >= lower) & (starts <= upper))
