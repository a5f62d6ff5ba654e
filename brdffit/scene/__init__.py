"""Scenes: a camera looks at shapes under lights."""

from brdffit.scene.camera import (
    Orthographic as Orthographic,
    Perspective as Perspective,
)
from brdffit.scene.files import load_scene as load_scene
from brdffit.scene.goniometer import Goniometer as Goniometer
from brdffit.scene.hits import Geometry as Geometry, Hits as Hits
from brdffit.scene.lights import (
    Ambient as Ambient,
    Directional as Directional,
    Environment as Environment,
    Point as Point,
)
from brdffit.scene.maps import Map as Map
from brdffit.scene.materials import Glass as Glass, Mirror as Mirror
from brdffit.scene.saving import save_scene as save_scene
from brdffit.scene.scene import Scene as Scene, lit_sphere as lit_sphere
from brdffit.scene.shadows import ShadowMap as ShadowMap, ShadowRays as ShadowRays
from brdffit.scene.shapes import Mesh as Mesh, Plane as Plane, Sphere as Sphere
from brdffit.scene.style import Gooch as Gooch
from brdffit.scene.surface import HeightMap as HeightMap, OpacityMap as OpacityMap
