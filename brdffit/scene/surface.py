"""Detail of a surface that its shape does not have: bumps and holes, as maps.

A map lies over the two surface coordinates of a shape, ``u`` and ``v``: longitude and
latitude of a sphere as on a light probe, lengths on a plane, those of the file on a
mesh. A plane repeats its map in both directions.
"""

from functools import partial

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit.scene import values
from brdffit.scene.maps import Map

Places = Float[np.ndarray, "n 2"]


class HeightMap(eqx.Module):
    """Bumps: how far the surface stands out along its normal.

    Attributes:
        map: Image file or pixels; the first channel is the height.
        scale: Height of the value 1, in the unit of the world.
        repeat: How often the map lies side by side along each coordinate.

    Raises:
        ValueError: A value is out of range, or a height is not finite.
        OSError: The file cannot be read.
    """

    map: Map = eqx.field(converter=partial(Map.of, "map"))
    scale: float = eqx.field(default=1.0, converter=partial(values.positive, "scale"))
    repeat: Float[np.ndarray, "2"] = eqx.field(
        default=1.0, converter=partial(values.pair, "repeat")
    )

    def __check_init__(self) -> None:
        """Refuse heights that are no numbers."""
        if not np.isfinite(self.map.pixels).all():
            raise ValueError(
                f"`map` must hold finite heights, but {self.map} does not."
            )

    def slopes(self, place: Places, endless: bool) -> Float[np.ndarray, "n 2"]:
        """Derivative of the height along ``u`` and ``v``, by central differences.

        The height is that between pixels, the step is that of one pixel to each side:
        so the slope is exact where the height is quadratic, and continuous.

        Args:
            place: Surface coordinates.
            endless: Whether the map goes on beyond ``v`` from 0 to 1.
        """
        rows, columns = self.map.pixels.shape[:2]
        end = None if endless else float(self.repeat[1])
        found = []
        for axis, pixels in enumerate((columns, rows)):
            step = np.eye(2)[axis] / pixels
            high, low = (
                self.map(place * self.repeat + sign * step, end)[:, 0]
                for sign in (1.0, -1.0)
            )
            found.append(self.scale * self.repeat[axis] * (high - low) * pixels / 2)
        return np.stack(found, axis=-1)


class OpacityMap(eqx.Module):
    """Holes: where a surface is, and where it is cut out.

    Attributes:
        map: Image file or pixels; the first channel is the opacity.
        threshold: Opacity below which there is no surface.
        repeat: How often the map lies side by side along each coordinate.

    Raises:
        ValueError: A value is out of range, or an opacity lies outside 0 to 1.
        OSError: The file cannot be read.
    """

    map: Map = eqx.field(converter=partial(Map.of, "map"))
    threshold: float = eqx.field(
        default=0.5, converter=partial(values.share, "threshold")
    )
    repeat: Float[np.ndarray, "2"] = eqx.field(
        default=1.0, converter=partial(values.pair, "repeat")
    )

    def __check_init__(self) -> None:
        """Refuse what is no opacity."""
        first = self.map.pixels[..., 0]
        if not np.all((first >= 0) & (first <= 1)):
            raise ValueError(
                f"`map` must hold opacities from 0 to 1, but {self.map} does not."
            )

    def solid(self, place: Places, endless: bool) -> np.ndarray:
        """Whether there is a surface at these places; arguments as for a height map."""
        end = None if endless else float(self.repeat[1])
        return self.map(place * self.repeat, end)[:, 0] >= self.threshold
