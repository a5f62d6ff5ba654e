"""Images of a BRDF: the geometry is traced once, then shaded as often as needed."""

from brdffit.render.geometry_pass import local_samples as local_samples, trace as trace
from brdffit.render.shading import render as render, shade as shade
