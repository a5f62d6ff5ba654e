import re

import numpy as np
import pytest

from brdffit.scene import (
    Directional,
    Orthographic,
    Scene,
    Sphere,
    lit_sphere,
    load_scene,
    save_scene,
)

GOOD = """
exposure = 2

[camera]
kind = "orthographic"
resolution = 16

[shape]
kind = "sphere"

[[lights]]
kind = "directional"
direction = [0.0, 0.6, 0.8]
irradiance = [1.0, 0.5, 0.25]

[[lights]]
kind = "directional"
direction = [1, 0, 0]
"""


def test_a_file_says_what_the_scene_is(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(GOOD)
    lights = (
        Directional([0.0, 0.6, 0.8], [1.0, 0.5, 0.25]),
        Directional([1.0, 0.0, 0.0]),
    )
    assert load_scene(path) == Scene(Orthographic(16), Sphere(), lights, 2.0)


def test_a_scene_survives_a_file_to_the_last_bit(tmp_path):
    path = tmp_path / "scene.toml"
    direction = np.array([0.1, 0.2, 0.3]) / np.linalg.norm([0.1, 0.2, 0.3])
    scene = lit_sphere(33, [direction], [1 / 3, 2 / 3, 1e-9], 0.1, "linear")
    save_scene(scene, path, {"model": "ggx", "noise": {"seed": 3}})
    assert load_scene(path) == scene
    assert '[provenance]\nmodel = "ggx"' in path.read_text()


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("exposure", "exposre", "key `exposre` must be one of .* mean `exposure`?"),
        ("resolution", "res", "in `camera`, key `res` must be one of resolution"),
        ('"sphere"', '"spher"', "`kind` of `shape`, `spher` must be .* mean `sphere`"),
        ('[shape]\nkind = "sphere"', "", "key `shape` is missing."),
        ('kind = "sphere"', "", "`shape` must say its `kind`: sphere"),
        ("direction = [1, 0, 0]", "", "in `lights[1]`, key `direction` is missing."),
        ("[1, 0, 0]", "[1, 0, 0.1]", "in `lights[1]`, `direction` must be a unit"),
        ("[1, 0, 0]", "[1, 0]", "`direction` must be three numbers, but is [1, 0]."),
        ("[1, 0, 0]", "[nan, 0, 0]", "`direction` must consist of finite numbers"),
        ("[1, 0, 0]", "[[1, 0], [1]]", "`direction` must consist of finite numbers"),
        ("[1, 0, 0]", '"up"', "`direction` must consist of finite numbers"),
        ("0.5, 0.25]", "0.5, -2]", "`irradiance` must be a number or a list of"),
        ("[1, 0, 0]", "[1, 0, 0]\nirradiance = [1, 2]", "same number of channels"),
        ("= 16", "= 16.5", "`resolution` must be a whole number, 1 or above, but is"),
        ("= 16", "= true", "`resolution` must be a whole number, 1 or above, but is"),
        ("exposure = 2", "exposure = 0", "`exposure` must be one number above 0"),
        ("exposure = 2", 'tangents = "radail"', "`radail` must be .* mean `radial`?"),
        ("exposure = 2", "tangents = 5", "`tangents` `5` must be one of linear"),
        ("exposure = 2", 'exposure = "2"', "`exposure` must consist of finite number"),
        ("[camera]", "[[camera]]", "`camera` must be a table"),
        ("[camera]", "[camera", "is not TOML"),
        ("\n\n[camera]", "\nlights = 3\n[camera]", "is not TOML"),
    ],
)
def test_whatever_is_wrong_is_said_with_file_and_key(tmp_path, old, new, sentence):
    path = tmp_path / "scene.toml"
    assert old in GOOD
    path.write_text(GOOD.replace(old, new))
    pattern = re.escape(sentence).replace(r"\.\*", ".*")
    with pytest.raises(ValueError, match=f"^Scene `{re.escape(str(path))}`.*{pattern}"):
        load_scene(path)


def test_lights_must_be_a_list_with_at_least_one(tmp_path):
    path = tmp_path / "scene.toml"
    dark = GOOD[: GOOD.index("[[lights]]")]
    path.write_text("lights = []" + dark)
    with pytest.raises(ValueError, match="`lights` must hold at least one light"):
        load_scene(path)
    path.write_text("lights = 3" + dark)
    with pytest.raises(ValueError, match="`lights` must be a list of tables"):
        load_scene(path)


def test_a_file_that_cannot_be_read_or_written_is_named(tmp_path):
    with pytest.raises(OSError, match=r"Scene `.*none.toml` cannot be read: No such"):
        load_scene(tmp_path / "none.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"Scene `.*binary.toml` is not TOML"):
        load_scene(tmp_path / "binary.toml")
    with pytest.raises(OSError, match=r"none/a.toml` cannot be written"):
        save_scene(lit_sphere(), tmp_path / "none" / "a.toml")
