"""From samples to a fitted model."""

from brdffit.fit.fit import fit as fit
from brdffit.fit.residual import RESIDUALS as RESIDUALS, Residual as Residual
from brdffit.fit.result import FitResult as FitResult, load_result as load_result
