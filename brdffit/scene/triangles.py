"""Triangles of a mesh, from arrays or from a file by way of trimesh."""

import os
from pathlib import Path
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Float, Int


class Triangles(eqx.Module):
    """Vertices and the faces between them.

    Attributes:
        vertices: Places of the vertices.
        faces: Three indices of vertices for each triangle, anticlockwise from outside.
        normals: Unit normals of the vertices.
        uv: Texture coordinates of the vertices, or None.
        convex: Whether the surface is closed and convex.
        file: Where they came from, or nothing.
    """

    vertices: Float[np.ndarray, "vertex 3"]
    faces: Int[np.ndarray, "triangle 3"]
    normals: Float[np.ndarray, "vertex 3"]
    uv: Float[np.ndarray, "vertex 2"] | None
    convex: bool = eqx.field(static=True)
    file: str = eqx.field(static=True, default="")

    @staticmethod
    def of(key: str, source: Any) -> "Triangles":
        """The triangles of a file, or of a pair of arrays: vertices and faces.

        Raises:
            ValueError: There is no triangle, a vertex is not finite, or a triangle has
                no area; the sentence begins with the key.
            OSError: The file cannot be read, or trimesh is not installed.
        """
        if isinstance(source, Triangles):
            return source
        mesh, file = _mesh(key, source)
        told = f"mesh `{file}`" if file else "the mesh"
        vertices = np.asarray(mesh.vertices, np.float64)
        faces = np.asarray(mesh.faces, np.int64)
        if len(faces) == 0:
            raise ValueError(f"`{key}`: {told} has no triangle.")
        if not np.isfinite(vertices).all():
            raise ValueError(f"`{key}`: {told} has a vertex that is not finite.")
        a, b, c = np.moveaxis(vertices[faces], 1, 0)
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        longest = np.maximum(np.abs(b - a).max(axis=1), np.abs(c - a).max(axis=1))
        empty = np.flatnonzero(area <= 1e-12 * longest**2)
        if len(empty):
            raise ValueError(
                f"`{key}`: {told} has {len(empty)} triangles without area, the first "
                f"of them triangle {empty[0]}: remove them."
            )
        uv = getattr(mesh.visual, "uv", None)
        return Triangles(
            vertices,
            faces,
            np.array(mesh.vertex_normals, np.float64),
            None if uv is None else np.array(uv, np.float64),
            bool(mesh.is_watertight and mesh.is_convex),
            file,
        )

    def __str__(self) -> str:
        """How sentences name them."""
        return f"mesh `{self.file}`" if self.file else "the mesh"


def _mesh(key: str, source: Any) -> tuple[Any, str]:
    """A mesh of trimesh, and the name of its file."""
    try:
        import trimesh  # optional
    except ImportError as error:
        raise OSError(
            "Meshes need trimesh: install brdffit with its optional part `mesh`."
        ) from error
    if not isinstance(source, str | Path):
        vertices, faces = _pair(key, source)
        return trimesh.Trimesh(vertices, faces, process=False), ""
    path = Path(source)
    if not os.path.isfile(path):  # also where the name itself cannot be
        raise FileNotFoundError(f"`{key}`: mesh `{path}` does not exist.")
    try:
        mesh: Any = trimesh.load(path, force="mesh", process=False)
        len(mesh.faces)  # which clouds of points do not have
    except Exception as error:  # trimesh raises nearly every kind on a damaged file
        raise OSError(f"`{key}`: `{path}` is no complete mesh file.") from error
    return mesh, str(path)


def _pair(key: str, source: Any) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces given as arrays.

    Raises:
        ValueError: They are something else.
    """
    try:
        vertices, faces = source
        vertices, faces = np.asarray(vertices, np.float64), np.asarray(faces)
        right = vertices.ndim == 2 and vertices.shape[1] == faces.shape[1] == 3
        right &= bool(faces.dtype.kind in "iu" and (faces >= 0).all())
        if right and (faces < len(vertices)).all():
            return vertices, faces
    except (TypeError, ValueError, IndexError):
        pass  # the sentence is the same
    raise ValueError(
        f"`{key}` must be a mesh file, or vertices (V, 3) with faces (F, 3) that hold "
        "indices of vertices."
    )
