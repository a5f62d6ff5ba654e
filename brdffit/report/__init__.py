"""The report of a fit or a comparison: one HTML file that needs nothing else."""

from brdffit.report.page import report as report
