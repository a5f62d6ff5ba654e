import re

import equinox as eqx
import numpy as np
import pytest
import trimesh

from brdffit import images
from brdffit.models import OrenNayar
from brdffit.scene import (
    Directional,
    Glass,
    Gooch,
    Mesh,
    Mirror,
    Orthographic,
    Scene,
    ShadowMap,
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

[[shapes]]
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
    assert load_scene(path) == Scene(Orthographic(16), (Sphere(),), lights, 2.0)


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
        (
            '"sphere"',
            '"spher"',
            "`kind` of `shapes[0]`, `spher` must be .* mean `sphere`",
        ),
        ('[[shapes]]\nkind = "sphere"', "", "key `shapes` is missing."),
        ("[[shapes]]", "[shape]", "key `shape` must be one of .* mean `shapes`?"),
        ('kind = "sphere"', "", "`shapes[0]` must say its `kind`: sphere"),
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
        ("= 16", "= 40000", "in `camera`, `resolution` must be 32768 or below"),
        ("= 16", "= 16\nheight = -2", "in `camera`, `height` must be one number above"),
        ("= 16", "= 16\ntarget = [0, 0, 1e300]", "`target` must have no number beyond"),
        (
            '"sphere"',
            '"sphere"\nradius = 1e-300',
            "`radius` must lie from 1e-12 to",
        ),
        (
            '"sphere"',
            '"sphere"\nheight = 1',
            "in `shapes[0]`, `height` must be a table",
        ),
        ("exposure = 2", "depth = 2000", "`depth` must be 1000 or below, but is 2000"),
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


RICH = """
depth = 3

[camera]
kind = "perspective"
resolution = [12, 16]
position = [0, 1, 5]

[[shapes]]
kind = "sphere"
radius = 0.5
opacity = {map = "holes.exr", threshold = 0.3}

[shapes.height]
map = "dents.exr"
scale = 0.02
repeat = 3

[[shapes]]
kind = "plane"
point = [0, -1, 0]
material = {model = "oren_nayar", albedo = [0.5, 0.5, 0.5], sigma = 0.4}

[[shapes]]
kind = "mesh"
file = "ball.obj"
smooth = true
material = {model = "glass", eta = 1.4}

[[shapes]]
kind = "sphere"
centre = [2, 0, 0]
material = {model = "mirror", eta = [0.2, 0.9, 1.1], k = [3.9, 2.4, 2.1]}

[[lights]]
kind = "point"
position = [1, 2, 3]
intensity = 20

[[lights]]
kind = "ambient"
radiance = [0.1, 0.1, 0.1]

[[lights]]
kind = "environment"
map = "probe.hdr"

[shadows]
kind = "map"
resolution = 64

[style]
kind = "gooch"
steps = 3
"""


@pytest.fixture(scope="module")
def rich(tmp_path_factory):
    """A folder with a scene that has everything."""
    folder = tmp_path_factory.mktemp("rich")
    grey = np.full((4, 8, 3), 0.5, np.float32)
    for name in ("holes.exr", "dents.exr", "probe.hdr"):
        images.write(folder / name, grey)
    trimesh.creation.icosphere(1).export(folder / "ball.obj")
    (folder / "scene.toml").write_text(RICH)
    return folder


def test_everything_that_a_scene_may_hold_is_read(rich):
    scene = load_scene(rich / "scene.toml")
    assert scene.camera.shape == (12, 16)
    assert scene.depth == 3
    ball, floor, mesh, mirror = scene.shapes
    assert ball.height is not None
    assert ball.height.scale == 0.02
    assert ball.opacity is not None
    assert ball.opacity.threshold == 0.3
    assert ball.material is None
    assert isinstance(floor.material, OrenNayar)
    np.testing.assert_allclose(floor.material.sigma, 0.4)
    assert isinstance(mesh, Mesh)
    assert mesh.smooth
    assert isinstance(mesh.material, Glass)
    assert isinstance(mirror.material, Mirror)
    assert isinstance(scene.shadows, ShadowMap)
    assert isinstance(scene.style, Gooch)
    assert scene.style.steps == 3
    assert scene.channels == 3


def test_everything_that_a_scene_may_hold_is_written(rich):
    scene = load_scene(rich / "scene.toml")
    save_scene(scene, rich / "again.toml")
    again = load_scene(rich / "again.toml")
    assert eqx.tree_equal(scene, again)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('"dents.exr"', '"none.exr"', "`shapes[0]`, in `height`, `map`: Image `.*none"),
        ('"dents.exr"', "5", "`map` must name a file, but is 5"),
        ("scale = 0.02", "depth = 0.02", "in `height`, key `depth` must be one of map"),
        ('"dents.exr"', '"."', "`map` must name a file, but `.*` is a folder."),
        ('"ball.obj"', '"none.obj"', "in `shapes[2]`, `file`: mesh `.*none.obj` does"),
        ('"probe.hdr"', '"none.hdr"', "in `lights[2]`, `map`: Image `.*none.hdr` does"),
        (
            "radius = 0.5",
            "radius = 0",
            "in `shapes[0]`, `radius` must be one number abo",
        ),
        ("point = [0, -1, 0]", "normal = [0, 2, 0]", "`normal` must be a unit vector"),
        (
            '"oren_nayar"',
            '"oren"',
            "`model` of `material`, `oren` must be .* `oren_nay",
        ),
        (
            "sigma = 0.4",
            "sgma = 0.4",
            "in `shapes[1]`, key `sgma` must be one of albedo",
        ),
        ("sigma = 0.4", "sigma = 4", "Parameter `sigma` of `oren_nayar` must lie in"),
        ("sigma = 0.4", "sigma = [1, 2]", "Parameter `sigma` of `oren_nayar` must be"),
        ("sigma = 0.4", 'sigma = "x"', "`sigma` must consist of finite numbers, but"),
        ("[0.2, 0.9, 1.1]", "[0.2, 0.9]", "`k` and `specular` must have the same num"),
        (
            "eta = [0.2, 0.9, 1.1], k = [3.9, 2.4, 2.1]",
            "specular = [0.5, 0.5]",
            "The material of `shapes[3]` must have the 3 channels of the lights",
        ),
        ("eta = [0.2, 0.9, 1.1]", "specular = 5", "`specular` must not be above 1"),
        (
            '"oren_nayar", albedo = [0.5, 0.5, 0.5], sigma = 0.4',
            '"ggx", separable = 3',
            "in `shapes[1]`, `separable` must be true or false, but is 3.",
        ),
        (
            '"oren_nayar", albedo = [0.5, 0.5, 0.5], sigma = 0.4',
            '"sum", first = {albedo = 1}',
            "in `shapes[1]`, `first` must say its `model`: one of the catalogue.",
        ),
        (
            '"oren_nayar", albedo = [0.5, 0.5, 0.5], sigma = 0.4',
            '"sum", first = {model = "lambert", albdo = 1}',
            "in `shapes[1]`, key `albdo` must be one of albedo.",
        ),
        ('"map"', '"rays"', "in `shadows`, key `resolution` is none"),
        ("eta = 1.4", "ior = 1.4", "in `shapes[2]`, key `ior` must be one of eta"),
        ('{model = "glass", eta = 1.4}', '"glass"', "`material` must be a table"),
        ('model = "glass"', "per_channel = []", "must have no `eta` beside `per_chan"),
        ('model = "glass", eta = 1.4', "per_channel = 1", "`per_channel` must be a li"),
        (
            'model = "glass", eta = 1.4',
            'per_channel = [{model = "glass"}]',
            "`model` of `per_channel[0]`, `glass` must be one of",
        ),
        ("position = [1, 2, 3]", "", "in `lights[0]`, key `position` is missing"),
        ("[0.1, 0.1, 0.1]", "[0.1, 0.1]", "same number of channels, but have 2, 3"),
        ("intensity = 20", "intensity = -1", "`intensity` must be a number or a list"),
        ("depth = 3", "depth = -1", "`depth` must be a whole number, 0 or above"),
        ("steps = 3", "steps = 0.5", "in `style`, `steps` must be a whole number"),
        ("smooth = true", "smooth = 1", "`smooth` must be true or false, but is 1"),
        (
            "resolution = 64",
            "size = 64",
            "in `shadows`, key `size` must be one of reso",
        ),
    ],
)
def test_whatever_is_wrong_with_a_part_is_said_with_its_key(rich, old, new, sentence):
    assert old in RICH
    path = rich / "wrong.toml"
    path.write_text(RICH.replace(old, new))
    pattern = re.escape(sentence).replace(r"\.\*", ".*")
    with pytest.raises(
        (ValueError, OSError), match=f"^Scene `.*wrong.toml`.*{pattern}"
    ):
        load_scene(path)
