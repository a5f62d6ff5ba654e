import numpy as np
import pytest

from brdffit import images
from brdffit.models import MODELS
from brdffit.render import provenance, simulate_image, trace
from brdffit.scene import lit_sphere, load_scene
from brdffit.scene.sidecar import load_toml
from brdffit.writers import sphere

BRDF = MODELS["lambert"](albedo=[0.8, 0.4, 0.2])
SCENE = lit_sphere(16)


def test_pixels_scene_truth_and_preview_stand_side_by_side(tmp_path):
    samples = simulate_image(BRDF, SCENE)
    sphere.save(samples, SCENE, tmp_path / "ball.exr", provenance(BRDF))
    image = images.read(tmp_path / "ball.exr").pixels
    where = samples.pixels
    np.testing.assert_array_equal(image[where.row, where.column], samples.value)
    assert np.count_nonzero(image.any(axis=-1)) == samples.mask[:, 0].sum()
    assert load_scene(tmp_path / "ball.toml") == SCENE
    assert load_toml(tmp_path / "ball.toml")["provenance"] == provenance(BRDF)
    assert images.read_mask(tmp_path / "ball.png").sum() == samples.mask[:, 0].sum()
    assert len(list(tmp_path.iterdir())) == 3


def test_samples_without_values_and_other_suffixes_are_refused(tmp_path):
    with pytest.raises(ValueError, match="must have values and pixels"):
        sphere.save(trace(SCENE), SCENE, tmp_path / "ball.exr")
    with pytest.raises(ValueError, match="must end in .exr"):
        sphere.save(trace(SCENE), SCENE, tmp_path / "ball.png")
    assert not list(tmp_path.iterdir())
