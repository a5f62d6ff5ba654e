import numpy as np
import pytest

import brdffit
from brdffit.subset import chances, subset, systematic
from tests.readers import specimens


def grid(count=4000, seed=0):
    """Cells of very different size, as MERL has them; a tenth is masked."""
    data = specimens.measurement(count=count, seed=seed)
    random = np.random.default_rng(seed)
    return brdffit.Measurement(
        data.wi,
        data.wo,
        data.f_r,
        mask=np.repeat(random.uniform(size=(count, 1)) > 0.1, 3, axis=1),
        solid_angle=random.lognormal(0, 2, count),
        name="grid",
    )


def test_sums_over_a_share_are_those_over_all():
    data = grid()
    use = data.mask[:, 0]
    exact = np.sum((data.f_r * data.solid_angle[:, None])[use])
    sums = []
    for seed in range(200):
        share = subset(data, 400, seed)
        assert share.mask.all()
        assert abs(len(share) - 400) <= 1
        sums.append(np.sum(share.f_r * share.solid_angle[:, None]))
    error = np.std(sums) / np.sqrt(len(sums))
    assert abs(np.mean(sums) - exact) < 4 * error
    assert np.std(sums) < 0.15 * exact


def test_the_share_is_stated_and_repeatable():
    share = subset(grid(), 400)
    assert share.name.startswith("grid (")
    assert share.name.endswith(f" of {int(grid().mask[:, 0].sum())} samples)")
    assert np.array_equal(share.wi, subset(grid(), 400).wi)
    assert not np.array_equal(share.wi, subset(grid(), 400, seed=1).wi)


def test_few_samples_stay_as_they_are():
    data = grid()
    assert subset(data, 4000) is data
    with pytest.raises(ValueError, match="must be 1 or above, but is 0"):
        subset(data, 0)


def test_chances_are_at_most_one_and_sum_to_the_count():
    share = np.random.default_rng(0).lognormal(0, 3, 1000)
    chance = chances(share / share.sum(), 100)
    assert chance.max() <= 1
    assert chance.sum() == pytest.approx(100)
    drawn = [len(systematic(chance, start)) for start in (0.0, 0.3, 0.999)]
    assert set(drawn) <= {99, 100, 101}


def test_pixels_keep_their_places():
    truth = brdffit.MODELS["lambert"](albedo=[0.5])
    image = brdffit.simulate_image(truth, brdffit.lit_sphere(32))
    share = subset(image, 50)
    assert len(share.pixels.row) == len(share)
    assert share.solid_angle.sum() == pytest.approx(
        image.mask.any(axis=1).sum(), rel=0.1
    )


def test_a_fit_to_a_share_finds_what_a_fit_to_all_finds():
    truth = brdffit.MODELS["lambert"](albedo=[0.5, 0.4, 0.3])
    instrument = brdffit.Goniometer(range(5, 80, 5), range(0, 81, 4), range(0, 360, 30))
    data = brdffit.simulate_measurement(truth, instrument, brdffit.Noise(relative=0.05))
    share = brdffit.fit("lambert", subset(data, 800), starts=1)
    whole = brdffit.fit("lambert", data, starts=1)
    errors = np.hypot(share.standard_errors["albedo"], whole.standard_errors["albedo"])
    distance = np.abs(share.parameters["albedo"] - whole.parameters["albedo"])
    assert np.all(distance < 4 * errors)
    assert "samples)" in share.data
