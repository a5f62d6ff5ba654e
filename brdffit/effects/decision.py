"""What is decided about one effect, and the facts that decisions look at."""

import dataclasses
from collections.abc import Callable
from functools import cached_property

import jax
import numpy as np

from brdffit.effects.quadrature import Regions, Rule
from brdffit.models.base import AbstractBRDF
from brdffit.scene import Geometry, Hits, Scene
from brdffit.scene.camera import Rays

MOST = 16384  # pixels that a decision looks at
COARSE = 32  # directions of a light probe, for an estimate


@dataclasses.dataclass(frozen=True)
class Decision:
    """Whether an effect is simulated, and why.

    Attributes:
        effect: Name of the effect, that of its file.
        needed: Whether the scene calls for it and leaving it out costs more than the
            tolerance.
        why: One sentence.
        error: Of leaving it out: root mean square of what changes, relative to that of
            the image, estimated for a white diffuse surface unless ``why`` says
            otherwise.
        cost: Of keeping it: arithmetic operations per pixel, counted.
        on: Whether it is simulated; as needed, unless the user says otherwise.
        number: Of directions, where there are any to choose.
    """

    effect: str
    needed: bool
    why: str
    error: float = 0.0
    cost: float = 0.0
    on: bool = False
    number: int = 0

    @property
    def overridden(self) -> bool:
        """Whether the user has said otherwise."""
        return self.on != self.needed


@dataclasses.dataclass(frozen=True)
class View:
    """A scene as decisions see it: some of its pixels, traced when first asked for.

    Attributes:
        scene: What is looked at.
        brdf: What shapes without a material are made of, or None when not yet known.
        tolerance: Error that is allowed.
        channels: Number of channels of the image.
        within: Which values of the parameters count: ``given``, ``typical``, or all
            within the ``bounds``.
    """

    scene: Scene
    brdf: AbstractBRDF | None
    tolerance: float
    channels: int
    within: str

    @cached_property
    def geometry(self) -> Geometry:
        """The shapes."""
        return Geometry(self.scene.shapes)

    @cached_property
    def rays(self) -> tuple[Rays, Rays]:
        """Origin and direction of the rays of evenly spread pixels."""
        rows, columns = self.scene.camera.shape
        step = int(np.ceil(np.sqrt(max(rows * columns / MOST, 1))))
        index = np.arange(rows * columns).reshape(rows, columns)
        chosen = index[step // 2 :: step, step // 2 :: step].ravel()
        return self.scene.camera.rays(chosen)

    @cached_property
    def regions(self) -> Regions:
        """The light probe, cut as often as decisions have asked for."""
        assert self.scene.probe is not None  # or no decision asks
        return Regions(self.scene.probe)

    @property
    def coarse_sky(self) -> Rule | None:
        """Few directions of the light probe, enough for an estimate."""
        return None if self.scene.probe is None else self.regions.rule(COARSE)

    @property
    def complete(self) -> bool:
        """Whether every pixel is looked at."""
        rows, columns = self.scene.camera.shape
        return rows * columns <= MOST

    @cached_property
    def hits(self) -> Hits:
        """What the pixels see, cut-outs not yet cut out."""
        return self.geometry.first_hits(*self.rays)

    def judged(
        self, effect: str, error: float, cost: float, why: str, small: str = ""
    ) -> Decision:
        """The decision about an effect that a scene calls for.

        Args:
            effect: Its name.
            error: Of leaving it out.
            cost: Of keeping it.
            why: What calls for it.
            small: Why it is left out when the error is within the tolerance.
        """
        needed = bool(error > self.tolerance)
        if not needed:
            why = f"{why}; {small or 'it changes less than the tolerance'}"
        return Decision(effect, needed, why, float(error), float(cost), needed)


def not_called_for(effect: str, why: str) -> Decision:
    """The decision about an effect that a scene does not call for."""
    return Decision(effect, needed=False, why=why)


def relative(change: np.ndarray, whole: np.ndarray) -> float:
    """Root mean square of a change, relative to that of the whole."""
    size = float(np.sqrt(np.mean(np.square(whole)))) if whole.size else 0.0
    part = float(np.sqrt(np.mean(np.square(change)))) if change.size else 0.0
    if size == 0:
        return 1.0 if part else 0.0
    return part / size


def operations(function: Callable, *arguments) -> float:
    """Numbers that a JAX function computes, counted in its traced program."""

    def count(jaxpr) -> int:
        total = 0
        for equation in jaxpr.eqns:
            inner = [
                value.jaxpr
                for value in equation.params.values()
                if hasattr(value, "jaxpr")
            ]
            if inner:
                total += sum(count(part) for part in inner)
            elif equation.primitive.name not in MOVING:
                total += sum(
                    int(np.prod(out.aval.shape, dtype=int)) for out in equation.outvars
                )
        return total

    return float(count(jax.make_jaxpr(function)(*arguments).jaxpr))


MOVING = {
    "broadcast_in_dim",
    "reshape",
    "slice",
    "squeeze",
    "concatenate",
    "convert_element_type",
    "transpose",
}
"""Primitives that move numbers and compute none."""
