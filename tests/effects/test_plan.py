import jax.numpy as jnp
import numpy as np
import pytest

from brdffit.effects import EFFECTS, plan
from brdffit.effects.exact_fresnel import added, removed
from brdffit.models import MODELS
from brdffit.render import render, trace
from brdffit.scene import (
    Ambient,
    Directional,
    Environment,
    Glass,
    Gooch,
    HeightMap,
    Mesh,
    Mirror,
    OpacityMap,
    Orthographic,
    Plane,
    Point,
    Scene,
    Sphere,
    lit_sphere,
)

CAMERA = Orthographic(24)
SUN = Directional([-0.48, 0.6, 0.64])
FLOOR = Plane([0, -1, 0])
GGX = MODELS["ggx"](alpha=0.3)
SQUARE = ([[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[0, 1, 2]])
BEFORE = Mesh(SQUARE, position=[-1.4, 1.8, 1.9], material=MODELS["lambert"]())
WAVES = np.sin(np.linspace(0, 6, 40)) * np.ones((20, 1))
SKY = np.ones((8, 16, 1))


def effects_of(made):
    return {name for name in made.decisions if made.on(name)}


def test_a_lone_sphere_under_one_light_calls_for_nothing():
    made = plan(lit_sphere(24), MODELS["lambert"]())
    assert effects_of(made) == set()
    assert set(made.decisions) == set(EFFECTS)
    assert all(d.why and d.error == d.cost == 0 for d in made.decisions.values())


@pytest.mark.parametrize(
    ("effect", "shapes", "lights", "more"),
    [
        ("ambient", (Sphere(),), (SUN, Ambient(0.1)), {}),
        ("falloff", (Sphere(),), (Point([0, 0, 3]),), {}),
        ("bump", (Sphere(height=HeightMap(WAVES, 0.05)),), (SUN,), {}),
        ("cut_out", (Sphere(opacity=OpacityMap(WAVES > 0)),), (SUN,), {}),
        ("shadows", (Sphere(), BEFORE), (SUN,), {}),
        ("environment", (Sphere(),), (Environment(SKY),), {}),
        ("bounces", (Sphere(material=Mirror()), FLOOR), (SUN,), {}),
        ("style", (Sphere(),), (SUN,), {"style": Gooch()}),
    ],
)
def test_each_effect_is_on_where_a_scene_calls_for_it(effect, shapes, lights, more):
    decision = plan(Scene(CAMERA, shapes, lights, **more), GGX).decisions[effect]
    assert decision.on
    assert decision.needed
    assert decision.error > 1e-3
    assert decision.cost > 0


@pytest.mark.parametrize(
    ("effect", "shapes", "lights", "why"),
    [
        ("ambient", (Sphere(),), (SUN, Ambient(0.0)), "no ambient light has radiance"),
        ("bump", (Sphere(height=HeightMap(SKY)),), (SUN,), "every height map is level"),
        ("cut_out", (Sphere(opacity=OpacityMap(SKY)),), (SUN,), "no opacity map falls"),
        ("shadows", (Sphere(), FLOOR), (Ambient(1.0),), "nothing casts a shadow"),
        ("bounces", (Sphere(material=Glass()),), (SUN,), "there is nothing to see in"),
    ],
)
def test_what_could_call_for_an_effect_may_not(effect, shapes, lights, why):
    decision = plan(Scene(CAMERA, shapes, lights), GGX).decisions[effect]
    assert not decision.on
    assert decision.why.startswith(why)


def test_shadows_seen_through_holes_are_estimated_as_large_as_they_are():
    """The near half of a hollow ball darkens the far half, seen through its holes."""
    ball = Sphere(opacity=OpacityMap((np.indices((16, 32)).sum(0) % 8 > 2) * 1.0))
    scene = Scene(CAMERA, (ball,), (SUN,))
    made = plan(scene, GGX)
    assert made.on("shadows")
    grey = MODELS["lambert"](albedo=1.0)
    bright = render(grey, scene, plan(scene, grey, without=["shadows"]))
    change = bright - render(grey, scene, made)
    measured = np.sqrt(np.mean(change**2) / np.mean(bright**2))
    assert made.decisions["shadows"].error == pytest.approx(measured, rel=0.01)


def test_mirrors_and_glass_alone_call_for_no_light_but_what_is_seen_in_them():
    shapes = (Sphere([-1, 0, 0], 0.5, Mirror()), Sphere([1, 0, 0], 0.5, Glass()))
    scene = Scene(CAMERA, shapes, (Environment(SKY), SUN))
    made = plan(scene, GGX)
    assert effects_of(made) == {"environment", "bounces"}
    more = plan(scene, GGX, with_=["shadows"])
    np.testing.assert_array_equal(render(GGX, scene, made), render(GGX, scene, more))


def test_shadows_that_fall_elsewhere_are_left_out():
    aside = Mesh(SQUARE, position=[5, 0, 0])
    decision = plan(Scene(CAMERA, (Sphere(), aside), (SUN,)), GGX).decisions["shadows"]
    assert not decision.on
    assert decision.why.startswith("none of 448 points looked at lies in shadow")


def test_a_shadow_between_the_points_looked_at_is_not_ruled_out(monkeypatch):
    monkeypatch.setattr("brdffit.effects.decision.MOST", 100)
    aside = Mesh(SQUARE, position=[5, 0, 0])
    decision = plan(Scene(CAMERA, (Sphere(), aside), (SUN,)), GGX).decisions["shadows"]
    assert decision.on
    assert decision.why.endswith("but some between them may")


def test_the_tolerance_decides_whether_falloff_matters():
    far = Scene(CAMERA, (Sphere(),), (Point([0, 0, 1000.0], 1e6),))
    error = plan(far).decisions["falloff"].error
    # irradiance varies by 2 / 1000 for each unit of depth, of which there is one
    assert 1e-4 < error < 2e-3
    assert plan(far, tolerance=error / 2).on("falloff")
    loose = plan(far, tolerance=error * 2)
    assert not loose.on("falloff")
    weights = {
        on: trace(far, made, 1)
        for on, made in ((True, plan(far, with_=["falloff"])), (False, loose))
    }
    exact, even = (weights[on].weight for on in (True, False))
    np.testing.assert_allclose(even, exact, rtol=4e-3)
    assert np.ptp(even[:, 0, 0] / weights[False].wi[:, 0, 2]) < 1e-5


def test_tangents_are_kept_while_the_brdf_is_not_known():
    assert plan(lit_sphere(8)).on("tangents")
    assert not plan(lit_sphere(8), GGX).on("tangents")
    ward = MODELS["ward_bounded"](alpha_x=0.1, alpha_y=0.4)
    assert plan(lit_sphere(8), ward).decisions["tangents"].error > 0.1
    even = MODELS["ward_bounded"](alpha_x=0.2, alpha_y=0.2)
    assert not plan(lit_sphere(8), even).on("tangents")
    assert plan(lit_sphere(8), GGX + ward).on("tangents")


def test_the_user_has_the_last_word_and_the_plan_says_so():
    scene = Scene(CAMERA, (Sphere(), BEFORE), (SUN,))
    made = plan(scene, GGX, without=["shadows"])
    assert not made.on("shadows")
    assert made.overridden == [
        "Effect `shadows` is off because it was asked for, although the scene calls "
        "for it."
    ]
    made = plan(lit_sphere(8), GGX, with_=["shadows", "tangents"])
    assert made.on("shadows")
    assert len(made.overridden) == 2
    assert plan(scene, GGX, with_=["shadows"]).overridden == []


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"with_": ["shadow"]}, "Effect `shadow` must be one of .* mean `shadows`?"),
        ({"with_": ["bump"], "without": ["bump"]}, "`bump` must be asked for or left"),
        ({"with_": ["bump"]}, "Effect `bump` needs a height map in the scene"),
        ({"with_": ["environment"]}, "Effect `environment` needs a light probe"),
        ({"tolerance": 0.0}, "The tolerance must be above 0"),
        ({"within": "all"}, "`within` `all` must be one of given, typical, bounds"),
    ],
)
def test_what_cannot_be_planned_is_refused(options, sentence):
    with pytest.raises(ValueError, match=sentence):
        plan(lit_sphere(8), GGX, **options)


def test_lost_energy_is_told_and_given_back_only_when_asked_for():
    rough = MODELS["ggx"](f0=[1.0, 0.8, 0.5], diffuse=0.0, alpha=1.0)
    made = plan(lit_sphere(8), rough)
    decision = made.decisions["multiple_scattering"]
    assert decision.error == pytest.approx(np.log(2), rel=0.01)
    assert decision.cost > made.decisions["exact_fresnel"].cost > 0
    assert not decision.on
    assert made.model(rough) is rough
    asked = plan(lit_sphere(8), rough, with_=["multiple_scattering"])
    again = asked.model(rough)
    assert type(again) is MODELS["ggx_multiscatter"]
    assert plan(lit_sphere(8), again).on("multiple_scattering")
    back = plan(lit_sphere(8), again, without=["multiple_scattering"]).model(again)
    assert type(back) is MODELS["ggx"]
    phong = MODELS["phong"]()
    asked = plan(lit_sphere(8), phong, with_=["multiple_scattering"])
    with pytest.raises(ValueError, match="cannot be added to `phong`"):
        asked.model(phong)


def test_schlick_and_fresnel_take_each_others_place_only_when_asked_for():
    metal = MODELS["conductor_ggx"](eta=[0.2, 0.9, 1.1], k=[3.9, 2.4, 2.1], alpha=0.3)
    made = plan(lit_sphere(8), metal)
    assert made.on("exact_fresnel")
    assert made.model(metal) is metal
    assert 0.01 < made.decisions["exact_fresnel"].error < 0.1
    off = plan(lit_sphere(8), metal, without=["exact_fresnel"]).model(metal)
    assert type(off) is MODELS["ggx_lobe"]
    wi, wo = jnp.array([0.0, 0.6, 0.8]), jnp.array([0.0, -0.6, 0.8])
    np.testing.assert_allclose(off(wi, wo), metal(wi, wo), rtol=0.02)
    glassy = MODELS["ggx"](diffuse=0.2, f0=[0.04, 0.05, 0.06], alpha=0.3)
    on = added(glassy)
    np.testing.assert_allclose(on(wi, wi), glassy(wi, wi), rtol=1e-5)
    assert on(wi, wo)[0] != pytest.approx(float(glassy(wi, wo)[0]), rel=1e-4)
    assert removed(glassy) is glassy


def test_a_plan_holds_for_the_worst_parameters_and_says_what_a_fit_spares():
    before = plan(lit_sphere(8), GGX, within="bounds")
    assert before.decisions["multiple_scattering"].error > 0.6
    ward = MODELS["ward_bounded"](alpha_x=0.1, alpha_y=0.4)
    even = MODELS["ward_bounded"](alpha_x=0.2, alpha_y=0.2)
    told = plan(lit_sphere(8), ward).less(plan(lit_sphere(8), even))
    assert told == ["`tangents` would not have been needed."]
