import numpy as np
from matplotlib.figure import Figure

from brdffit.plots.residual_map import half_and_difference, plot_residual_map
from brdffit.samples import Measurement, as_samples


def test_a_cell_has_the_mean_of_its_errors_and_nothing_where_none_is():
    half, difference = np.array([10.0, 10.0, 70.0]), np.array([20.0, 20.0, 40.0])
    error = np.array([[0.1, 0.3], [0.2, np.nan], [-0.5, -0.5]])
    axes = Figure().subplots()
    cells = plot_residual_map(axes, half, difference, error, 1.0)
    values = np.asarray(cells.get_array())
    assert sorted(np.round(values, 12)) == [-0.5, 0.2]
    assert cells.get_clim() == (-1.0, 1.0)
    assert all("degrees" in label for label in (axes.get_xlabel(), axes.get_ylabel()))


def test_retroreflection_has_no_difference_and_the_mirror_no_tilt():
    tilt = np.radians(30)
    light = [np.sin(tilt), 0, np.cos(tilt)]
    mirrored = [-np.sin(tilt), 0, np.cos(tilt)]
    data = Measurement(
        np.array([light, light]), np.array([light, mirrored]), np.ones((2, 1))
    )
    half, difference = half_and_difference(as_samples(data))
    np.testing.assert_allclose(half, [30, 0], atol=1e-6)
    np.testing.assert_allclose(difference, [0, 30], atol=1e-6)
