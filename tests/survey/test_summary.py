import dataclasses

import numpy as np
import pytest

import brdffit
from brdffit.survey import summary
from tests.readers import specimens


def test_values_are_counted_by_the_reason_why_they_are_not_used():
    data = specimens.measurement(count=40)
    f_r, wo = data.f_r.copy(), data.wo.copy()
    f_r[0], f_r[1, 0], f_r[2, 2] = -1, np.nan, np.inf
    wo[3] = [0.6, 0, -0.8]
    mask = np.isfinite(f_r) & (f_r >= 0)
    mask[3:5] = False
    facts = summary(dataclasses.replace(data, f_r=f_r, wo=wo, mask=mask))
    assert facts.invalid == {
        "below the horizon": 3,
        "not finite": 2,
        "negative": 3,
        "masked by the file, saturated or unlit": 3,
    }
    assert facts.usable + sum(facts.invalid.values()) == facts.samples * 3
    assert facts.lowest == pytest.approx(np.where(mask, f_r, np.inf).min(axis=0))
    assert facts.highest == pytest.approx(np.where(mask, f_r, -np.inf).max(axis=0))
    assert facts.quantity == "f_r [1/sr]"


def test_angles_and_images_are_told():
    truth = brdffit.MODELS["lambert"](albedo=[0.5])
    instrument = brdffit.Goniometer([10, 40], range(0, 81, 10), [0, 180])
    facts = summary(brdffit.simulate_measurement(truth, instrument))
    assert facts.theta_i == pytest.approx((10, 40), abs=1e-4)
    assert facts.theta_o == pytest.approx((0, 80), abs=0.03)  # float32 at the normal
    assert (facts.images, facts.lights, facts.azimuths) == (0, 1, 1)

    lights = [(0.6, 0, 0.8), (0, 0.6, 0.8)]
    image = brdffit.simulate_image(truth, brdffit.lit_sphere(16, lights))
    facts = summary(image)
    assert (facts.images, facts.lights, facts.quantity) == (1, 2, "pixel value")
    assert facts.reciprocity is None
