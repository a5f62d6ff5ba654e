"""Images of a BRDF: the geometry is traced once, then shaded as often as needed."""

from brdffit.render.geometry_pass import local_samples as local_samples, trace as trace
from brdffit.render.noise import NOISELESS as NOISELESS, Noise as Noise
from brdffit.render.paths import (
    materials_of as materials_of,
    radiance as radiance,
    trace_paths as trace_paths,
)
from brdffit.render.picture import render as render
from brdffit.render.shading import shade as shade
from brdffit.render.simulate import (
    description as description,
    provenance as provenance,
    simulate_image as simulate_image,
    simulate_measurement as simulate_measurement,
)
from brdffit.render.texture import (
    render_texture as render_texture,
    shade_texels as shade_texels,
)
