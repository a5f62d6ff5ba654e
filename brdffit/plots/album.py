"""All figures that suit a fit or a comparison, one after another."""

from collections.abc import Iterator

from matplotlib.figure import Figure

from brdffit.fit import FitResult
from brdffit.fit.select import Comparison
from brdffit.plots.lobe import lobe_figure
from brdffit.plots.plane import planes
from brdffit.plots.ranking import ranking_figure
from brdffit.plots.residuals import residuals_figure
from brdffit.plots.spheres import spheres_figure
from brdffit.samples import Measurement, Samples


def album(
    data: Measurement | Samples, outcome: FitResult | Comparison
) -> Iterator[tuple[str, Figure]]:
    """Name and figure of every kind: lobes, spheres, residuals and ranking.

    Left out are lobes of data without a plane under a single light, and the ranking of
    a single fit.
    """
    single = isinstance(outcome, FitResult)
    results = {outcome.model: outcome} if single else outcome.results
    if planes(data):
        yield "lobes", lobe_figure(data, results)
    yield "spheres", spheres_figure(data, results)
    yield "residuals", residuals_figure(data, results)
    if not single:
        yield "ranking", ranking_figure(outcome)
