"""Cameras: where the ray of each pixel starts and where it goes.

The world is right-handed with y up. Rays pass through the centres of pixels; row 0 is
the top of the image.
"""

from functools import partial

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit.scene import values

Rays = Float[np.ndarray, "pixel 3"]


class Orthographic(eqx.Module):
    """Parallel rays along -z onto the square from -1 to 1 in x and y.

    A unit sphere at the origin fills the frame; the viewer is at infinity on +z.

    Attributes:
        resolution: Rows and columns of the image.
    """

    resolution: int = eqx.field(
        static=True, converter=partial(values.whole, "resolution", least=1)
    )

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the image."""
        return self.resolution, self.resolution

    def rays(self) -> tuple[Rays, Rays]:
        """Origin and unit direction of the ray of each pixel, row by row."""
        centre = (2 * np.arange(self.resolution) + 1) / self.resolution - 1
        y, x = np.meshgrid(-centre, centre, indexing="ij")
        origin = np.stack([x.ravel(), y.ravel(), np.ones(x.size)], axis=-1)
        return origin, np.broadcast_to([0.0, 0.0, -1.0], origin.shape)
