"""The plan: which effects a scene calls for, why, and at what price.

The plan is made before anything is simulated, from the scene and what is known of the
BRDF. It never changes a model unless the user asks for it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from brdffit.effects import (
    ambient,
    bounces,
    bump,
    cut_out,
    environment,
    exact_fresnel,
    falloff,
    multiple_scattering,
    shadows,
    style,
    tangents,
)
from brdffit.effects.decision import Decision, View, not_called_for
from brdffit.effects.quadrature import Rule
from brdffit.effects.worst import RANGES
from brdffit.models.base import AbstractBRDF
from brdffit.names import look_up
from brdffit.scene import Scene

OF_SCENE = {
    part.NAME: part
    for part in (
        ambient,
        falloff,
        tangents,
        bump,
        cut_out,
        shadows,
        environment,
        bounces,
        style,
    )
}
OF_MODEL = {part.NAME: part for part in (multiple_scattering, exact_fresnel)}
EFFECTS = OF_SCENE | OF_MODEL
TOLERANCE = 1e-3
DRAWN = (bump.NAME, cut_out.NAME, style.NAME)  # what pictures in a style have


@dataclasses.dataclass(frozen=True)
class Plan:
    """What is simulated of a scene.

    Attributes:
        decisions: One for each effect, by name.
        tolerance: Relative error that each may leave.
        sky: Directions of the light probe, or None without one.
        middle: Point as far as which all points are from a point light, where distance
            falloff is left out.
    """

    decisions: dict[str, Decision]
    tolerance: float
    sky: Rule | None = None
    middle: np.ndarray | None = None

    def on(self, effect: str) -> bool:
        """Whether an effect is simulated."""
        decision = self.decisions.get(effect)
        return decision is not None and decision.on

    @property
    def directions(self) -> int:
        """Number of directions of the light probe."""
        return 0 if self.sky is None else len(self.sky.towards)

    @property
    def overridden(self) -> list[str]:
        """One sentence for each effect about which the user has said otherwise."""
        return [
            f"Effect `{name}` is {'on' if d.on else 'off'} because it was asked for, "
            f"although the scene {'calls' if d.needed else 'does not call'} for it."
            for name, d in self.decisions.items()
            if d.overridden
        ]

    def less(self, other: "Plan") -> list[str]:
        """What another plan of the same scene, as for a fitted BRDF, does not need."""
        told = [
            f"`{name}` would not have been needed."
            for name, decision in self.decisions.items()
            if decision.on and name in other.decisions and not other.on(name)
        ]
        if 0 < other.directions < self.directions:
            told.append(
                f"{other.directions} directions of the light probe would have done "
                f"instead of {self.directions}."
            )
        return told

    def model(self, brdf: AbstractBRDF) -> AbstractBRDF:
        """The model to render with: another one only where the user asks for it.

        Raises:
            ValueError: The catalogue has no such model.
        """
        for name, part in OF_MODEL.items():
            decision = self.decisions.get(name)
            if decision is not None and decision.overridden:
                brdf = part.added(brdf) if decision.on else part.removed(brdf)
        return brdf


def plan(
    scene: Scene,
    brdf: AbstractBRDF | None = None,
    *,
    tolerance: float = TOLERANCE,
    with_: Sequence[str] = (),
    without: Sequence[str] = (),
    within: str = "given",
    channels: int | None = None,
) -> Plan:
    """Decide for each effect whether it is simulated.

    Args:
        scene: What is to be simulated.
        brdf: What shapes without a material are made of, as far as it is known.
        tolerance: Effects that change an image by less are left out, and light probes
            get as many directions as keep their error below it.
        with_: Effects to simulate in any case.
        without: Effects to leave out in any case.
        within: Which parameters the plan must hold for: those ``given``, or the worst
            of the ``typical`` range or the ``bounds``, as before a fit.
        channels: Number of channels; by default that of the BRDF or the lights.

    Raises:
        ValueError: There is no such effect or range, an effect is asked for both ways,
            or the scene has nothing for it to work on.
    """
    chosen = (*OF_SCENE, *OF_MODEL)
    return _plan(scene, brdf, chosen, tolerance, with_, without, within, channels)


def plan_for_tracing(
    scene: Scene, brdf: AbstractBRDF | None = None, channels: int | None = None
) -> Plan:
    """The default plan with only what tracing asks for: effects of the scene."""
    return _plan(scene, brdf, tuple(OF_SCENE), TOLERANCE, (), (), "given", channels)


def _plan(scene, brdf, chosen, tolerance, with_, without, within, channels) -> Plan:
    for name in (*with_, *without):
        look_up(EFFECTS, name, "Effect")
    if both := set(with_) & set(without):
        raise ValueError(
            f"Effect `{min(both)}` must be asked for or left out, not both."
        )
    if not tolerance > 0:
        raise ValueError(f"The tolerance must be above 0, but is {tolerance:g}.")
    look_up(dict.fromkeys(RANGES), within, "`within`")
    wanted = channels or (None if brdf is None else brdf.channels)
    view = View(scene, brdf, tolerance, scene.channels_for(wanted), within)
    drawn = scene.style is not None and style.NAME not in without
    decisions = {
        name: not_called_for(name, "the style does without it")
        if drawn and name not in DRAWN
        else EFFECTS[name].decide(view)
        for name in chosen
    }
    for name, on in [*((n, True) for n in with_), *((n, False) for n in without)]:
        decisions[name] = dataclasses.replace(decisions[name], on=on)
    _check(scene, decisions)
    made = Plan(decisions, tolerance)
    if decisions[environment.NAME].on:
        sky = view.regions.rule(decisions[environment.NAME].number)
        made = dataclasses.replace(made, sky=sky)
    lights_fall_off = decisions[falloff.NAME]
    if lights_fall_off.error and not lights_fall_off.on:
        made = dataclasses.replace(made, middle=falloff.middle(view.hits))
    return made


def _check(scene: Scene, decisions: dict[str, Decision]) -> None:
    """Refuse effects that a scene has nothing for."""
    lacking = {
        environment.NAME: scene.probe is None and "a light probe",
        style.NAME: scene.style is None and "a table `style`",
        bump.NAME: all(s.height is None for s in scene.shapes) and "a height map",
        cut_out.NAME: all(s.opacity is None for s in scene.shapes) and "an opacity map",
        bounces.NAME: not bounces.smooth_shapes(scene.shapes) and "a mirror or glass",
    }
    for name, thing in lacking.items():
        if decisions[name].on and thing:
            raise ValueError(f"Effect `{name}` needs {thing} in the scene.")
