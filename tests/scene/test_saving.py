import equinox as eqx
import pytest

from brdffit.catalogue import from_description
from brdffit.per_channel import PerChannel
from brdffit.scene import (
    Directional,
    HeightMap,
    Orthographic,
    Perspective,
    Scene,
    Sphere,
    load_scene,
    save_scene,
)

SUN = Directional([0.0, 0.0, 1.0])


def test_a_scene_from_arrays_says_what_it_needs_to_be_written(tmp_path):
    lumpy = Sphere(height=HeightMap([[0.0, 1.0]]))
    scene = Scene(Orthographic(4), (lumpy,), (Directional([0, 0, 1]),))
    with pytest.raises(ValueError, match="cannot be written: save it as a file first"):
        save_scene(scene, tmp_path / "a.toml")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "camera",
    [
        Orthographic((4, 6), [0, 0.6, 0.8], [1, 2, 3], [1, 0, 0], height=6),
        Perspective(4, [0, 1, 5], [0, 1, 0], [1, 1, 0], field_of_view=25),
    ],
    ids=["orthographic", "perspective"],
)
def test_a_camera_with_everything_set_is_read_as_it_was_written(tmp_path, camera):
    scene = Scene(camera, (Sphere(),), (SUN,))
    save_scene(scene, tmp_path / "a.toml")
    assert eqx.tree_equal(load_scene(tmp_path / "a.toml"), scene)


def test_a_material_with_a_model_for_each_channel_is_read_as_it_was_written(tmp_path):
    ggx = {"model": "ggx", "diffuse": [0.2], "f0": [0.3]}
    parts = [from_description(ggx | {"alpha": alpha}) for alpha in (0.1, 0.2)]
    shapes = (Sphere(material=PerChannel(tuple(parts))),)
    scene = Scene(Orthographic(4), shapes, (SUN,))
    save_scene(scene, tmp_path / "a.toml")
    assert eqx.tree_equal(load_scene(tmp_path / "a.toml"), scene)
