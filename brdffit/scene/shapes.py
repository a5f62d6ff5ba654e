"""Shapes: what there is to see, and of what it is made."""

from functools import partial
from typing import Any, ClassVar

import equinox as eqx
import numpy as np
from jaxtyping import Float

from brdffit.models.base import AbstractBRDF
from brdffit.scene import values
from brdffit.scene.materials import Glass, Mirror
from brdffit.scene.surface import HeightMap, OpacityMap
from brdffit.scene.triangles import Triangles

Material = AbstractBRDF | Mirror | Glass
Numbers = Float[np.ndarray, "..."]


class Sphere(eqx.Module):
    """A sphere; by default the unit sphere at the origin.

    Attributes:
        centre: Its centre.
        radius: Its radius.
        material: What it is made of, or None for what the scene is rendered with.
        height: Bumps; ``u`` is the longitude and ``v`` the latitude, as on a probe.
        opacity: Holes, in the same coordinates.

    Raises:
        ValueError: The radius is not above 0.
    """

    centre: Numbers = eqx.field(
        default=(0.0, 0.0, 0.0), converter=partial(values.point, "centre")
    )
    radius: float = eqx.field(default=1.0, converter=partial(values.length, "radius"))
    material: Material | None = None
    height: HeightMap | None = None
    opacity: OpacityMap | None = None

    endless: ClassVar[bool] = False

    @property
    def convex(self) -> bool:
        """Whether it never stands between a light and itself."""
        return self.opacity is None


class Plane(eqx.Module):
    """An endless plane, seen from both sides.

    Attributes:
        point: Any point of it.
        normal: Unit vector perpendicular to it.
        material, height, opacity: As for a sphere; ``u`` and ``v`` are lengths from
            the point, in the directions of `axes`.

    Raises:
        ValueError: The normal is not a unit vector.
    """

    point: Numbers = eqx.field(
        default=(0.0, 0.0, 0.0), converter=partial(values.point, "point")
    )
    normal: Numbers = eqx.field(
        default=(0.0, 1.0, 0.0), converter=partial(values.unit_vector, "normal")
    )
    material: Material | None = None
    height: HeightMap | None = None
    opacity: OpacityMap | None = None

    endless: ClassVar[bool] = True
    convex: ClassVar[bool] = True

    @property
    def axes(self) -> tuple[Numbers, Numbers]:
        """Unit vectors in the plane: the first along x where the plane allows it."""
        along = np.eye(3)[0] if abs(self.normal[0]) < 0.9 else np.eye(3)[1]
        first = along - self.normal * self.normal.dot(along)
        first /= np.linalg.norm(first)
        return first, np.cross(self.normal, first)


class Mesh(eqx.Module):
    """A mesh of triangles, seen from both sides.

    Attributes:
        file: OBJ, PLY, glTF or another file that trimesh reads, or vertices ``(V, 3)``
            and faces ``(F, 3)`` as a pair of arrays.
        position: Added to all vertices, after scaling.
        scale: Factor of all vertices.
        smooth: Interpolate the normals of vertices across triangles.
        material, height, opacity: As for a sphere; ``u`` and ``v`` are those of the
            file.

    Raises:
        ValueError: There is no triangle, one has no area, or a map lies on a mesh
            without coordinates.
        OSError: The file cannot be read, or trimesh is not installed.
    """

    file: Triangles = eqx.field(converter=partial(Triangles.of, "file"))
    position: Numbers = eqx.field(
        default=(0.0, 0.0, 0.0), converter=partial(values.point, "position")
    )
    scale: float = eqx.field(default=1.0, converter=partial(values.length, "scale"))
    smooth: bool = eqx.field(
        static=True, default=False, converter=partial(values.boolean, "smooth")
    )
    material: Material | None = None
    height: HeightMap | None = None
    opacity: OpacityMap | None = None

    endless: ClassVar[bool] = True

    def __check_init__(self) -> None:
        """Refuse maps that nothing places."""
        for key in ("height", "opacity"):
            if getattr(self, key) is not None and self.file.uv is None:
                raise ValueError(
                    f"`{key}` needs texture coordinates, but {self.file} has none."
                )

    @property
    def corners(self) -> Float[np.ndarray, "triangle 3 3"]:
        """The three corners of each triangle, in the world."""
        return (self.scale * self.file.vertices + self.position)[self.file.faces]

    @property
    def convex(self) -> bool:
        """Whether it never stands between a light and itself."""
        return self.opacity is None and self.file.convex


Shape = Sphere | Plane | Mesh
SHAPES: dict[str, Any] = {"sphere": Sphere, "plane": Plane, "mesh": Mesh}
