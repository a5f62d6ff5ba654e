"""First hits of large meshes by Embree, sharpened to double precision.

Embree finds the triangle in single precision; the point on it is worked out again. A
ray that passes an edge closer than single precision may be given to the neighbour.
"""

import jax
import numpy as np
from jaxtyping import Float

from brdffit.scene import intersection
from brdffit.scene.nearest import Meeting

MANY = 2048  # triangles beyond which a mesh is given to Embree
START = 1e-5  # how far from its origin a ray begins, relative to the size of the mesh


class Engine:
    """The triangles of one mesh, sorted in space.

    Raises:
        OSError: Embree is not installed.
    """

    def __init__(self, corners: Float[np.ndarray, "triangle 3 3"]) -> None:
        """Sort the triangles."""
        try:
            import trimesh
            from trimesh.ray.ray_pyembree import RayMeshIntersector
        except (ImportError, ModuleNotFoundError) as error:
            raise OSError(
                f"Meshes of more than {MANY} triangles need embreex: install brdffit "
                "with its optional part `mesh`."
            ) from error
        faces = np.arange(corners.size // 3).reshape(-1, 3)
        mesh = trimesh.Trimesh(corners.reshape(-1, 3), faces, process=False)
        self.corners = corners
        self.start = START * float(np.ptp(corners, axis=(0, 1)).max())
        self.engine = RayMeshIntersector(mesh)

    def first_hits(self, origin: np.ndarray, direction: np.ndarray) -> Meeting:
        """What each ray meets first."""
        begin = origin + self.start * direction
        found = np.asarray(self.engine.intersects_first(begin, direction))
        which = np.maximum(found, 0)
        with jax.enable_x64(True):
            distance, u, v, normal = map(
                np.asarray, _sharpened(origin, direction, self.corners[which])
            )
        distance = np.where(found >= 0, distance, np.inf)
        return Meeting(distance, which, normal, np.stack([u, v], axis=1))


@jax.jit
def _sharpened(origin, direction, corners):
    def one(origin, direction, corners):
        return (
            *intersection.on_plane_of(origin, direction, corners),
            intersection.normal_of(corners),
        )

    return jax.vmap(one)(origin, direction, corners)
