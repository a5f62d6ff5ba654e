import brdffit
from brdffit.plots import album
from tests.results import comparison_of, result_of


def test_a_comparison_has_every_kind_of_figure(goniometer, truth):
    names = [name for name, _ in album(goniometer, comparison_of(truth))]
    assert names == ["lobes", "spheres", "residuals", "ranking"]


def test_a_fit_has_no_ranking(goniometer, truth):
    names = [name for name, _ in album(goniometer, result_of(truth))]
    assert names == ["lobes", "spheres", "residuals"]


def test_several_lights_have_no_lobes(truth):
    scene = brdffit.lit_sphere(32, ((0, 0, 1), (0.6, 0, 0.8)))
    image = brdffit.simulate_image(truth, scene)
    result = result_of(truth, "cosine_weighted")
    assert [name for name, _ in album(image, result)] == ["spheres", "residuals"]
