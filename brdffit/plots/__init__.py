"""Figures, one kind per file; each file draws into given axes and makes a figure."""

from brdffit.plots.album import album as album
from brdffit.plots.coverage import coverage_figure as coverage_figure
from brdffit.plots.lobe import lobe_figure as lobe_figure, plot_lobe as plot_lobe
from brdffit.plots.maps import maps_figure as maps_figure
from brdffit.plots.plane import Plane as Plane, planes as planes
from brdffit.plots.profile import profile_figure as profile_figure
from brdffit.plots.ranking import (
    plot_errors as plot_errors,
    plot_table as plot_table,
    ranking_figure as ranking_figure,
)
from brdffit.plots.relit import relit_figure as relit_figure
from brdffit.plots.residuals import (
    plot_residuals as plot_residuals,
    residuals_figure as residuals_figure,
)
from brdffit.plots.spheres import (
    plot_difference as plot_difference,
    plot_sphere as plot_sphere,
    spheres_figure as spheres_figure,
)
from brdffit.plots.style import save as save
from brdffit.plots.thumbnail import thumbnail_figure as thumbnail_figure
