import numpy as np
import pytest

from brdffit import MODELS, plots
from brdffit.plots.maps import plot_map, window
from brdffit.plots.style import new_figure
from tests import wall

SHAPE = (8, 12)


@pytest.fixture
def maps():
    """Those of a wall, in the lower rows only; alpha is known in half of them."""
    found = wall.maps(SHAPE)
    found |= {f"{name}_error": 0.1 * image for name, image in found.items()}
    found["alpha_error"][:, :6] = np.inf
    found["rms"] = np.full((*SHAPE, 1), 0.01)
    found["converged"] = np.ones((*SHAPE, 1))
    found["at_bound"] = np.zeros((*SHAPE, 1))
    found["converged"][5, :6] = 0
    found["at_bound"][6] = 1
    for image in found.values():
        image[:4] = np.nan
    return found


def numbers(axes, place=0):
    return np.ma.filled(axes.images[place].get_array().astype(float), np.nan)


def test_a_sheet_shows_every_parameter_its_error_and_the_end_of_the_fit(maps):
    figure = plots.maps_figure(MODELS["ggx"](), maps, "wall")
    panels = [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]
    titles = [axes.get_title() for axes in panels]
    assert [title.split()[0].strip(":") for title in titles] == [
        *("diffuse", "diffuse", "f0", "f0", "alpha", "alpha", "residual", "end")
    ]
    assert "not determined" in titles[4]
    assert "not determined" not in titles[0]
    for axes in panels:
        assert numbers(axes).shape[:2] == (4, 12), "empty rows are cut off"
    np.testing.assert_allclose(numbers(panels[4])[:, 6:], maps["alpha"][4:, 6:, 0])
    assert np.isnan(numbers(panels[4])[:, :6]).all()
    assert numbers(panels[4], 1)[:, :6, 3].all(), "grey where not known"


def test_the_end_of_the_fit_is_told_in_shares(maps):
    figure = plots.maps_figure(MODELS["ggx"](), maps, "wall")
    labels = [text.get_text() for text in figure.axes[-1].get_yticklabels()]
    assert labels == [
        "converged\n62.50 %",
        "converged\nat a bound\n25.00 %",
        "not converged\n12.50 %",
    ]


def test_scales_end_where_most_numbers_do_and_say_so():
    axes = new_figure(3.0, 3.0).subplots()
    image = np.linspace(1, 2, 400).reshape(20, 20)
    image[0, 0], image[0, 1] = -50, 100
    plot_map(axes, image, "title", "label")
    low, high = axes.images[0].get_clim()
    assert 1 <= low < 1.05 < 1.95 < high <= 2
    assert axes.images[0].colorbar.extend == "both"
    plot_map(axes, np.full((4, 4), np.nan), "nothing", "label")


def test_a_parameter_over_decades_has_a_logarithmic_scale(maps):
    maps["alpha"][4:] = np.geomspace(1e-3, 0.5, 48).reshape(4, 12, 1)
    maps["alpha_error"][4:] = 0.1
    figure = plots.maps_figure(MODELS["ggx"](), maps, "wall")
    panel = next(axes for axes in figure.axes if axes.get_title().startswith("alpha $"))
    assert type(panel.images[0].norm).__name__ == "LogNorm"


def test_a_large_map_is_thinned_out():
    image = np.full((1000, 30, 1), np.nan)
    image[100:900, 5:25] = 1
    assert window(image, 400) == (slice(100, 900, 2), slice(5, 25, 1))


def test_a_photograph_stands_beside_its_prediction():
    photograph = np.random.default_rng(0).uniform(0.1, 0.4, (6, 8, 3))
    predicted = photograph + 0.01
    photograph[0] = np.nan
    figure = plots.relit_figure(photograph, predicted, "wall")
    seen, shown, difference, bar = figure.axes
    assert seen.get_title() == "photograph, held out"
    assert shown.get_title() == "predicted"
    assert "grey: not compared" in difference.get_title()
    np.testing.assert_allclose(numbers(difference, 1)[1:], 0.01)
    assert np.isnan(numbers(difference, 1)[0]).all()
    assert bar.get_ylabel() == "radiance, mean of channels"
    assert not (numbers(seen)[0, :, 3]).any(), "empty where there is no photograph"
