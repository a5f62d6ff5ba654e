"""Scenes: a camera looks at a shape under lights."""

from brdffit.scene.camera import Orthographic as Orthographic
from brdffit.scene.files import load_scene as load_scene, save_scene as save_scene
from brdffit.scene.goniometer import Goniometer as Goniometer
from brdffit.scene.lights import Directional as Directional
from brdffit.scene.scene import Scene as Scene, lit_sphere as lit_sphere
from brdffit.scene.shapes import Sphere as Sphere
