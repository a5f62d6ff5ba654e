"""Two reflectance models added."""

from typing import Any, ClassVar

import equinox as eqx

from brdffit.models.base import AbstractBRDF
from brdffit.models.ggx_lobe import GGXLobe
from brdffit.models.lambert import Lambert
from brdffit.types import Direction, Spectrum


class OfBothParts:
    """A fact that holds for a sum when it does for both parts.

    Asked of the class, it is that of the default pair.
    """

    def __set_name__(self, owner: type, name: str) -> None:
        """Remember which fact."""
        self.name = name

    def __get__(self, pair: "Sum | None", owner: type) -> bool:
        """Ask the parts."""
        parts = (Lambert, GGXLobe) if pair is None else (pair.first, pair.second)
        return all(getattr(part, self.name) for part in parts)


class Sum(AbstractBRDF):
    r"""Two models side by side, neither attenuating the other; ``a + b`` builds it.

    $$f_r = f_1 + f_2$$

    Parameters carry the name of their part, as in ``first.albedo``; a part may be a sum
    in turn.

    Range:
        As the parts. A sum is reciprocal when both are, and isotropic when both are
        (the default pair is both). No sum is declared to conserve energy: albedos add,
        and parts that stay within 1 alone say nothing of how much they leave to each
        other. The default pair exceeds 1 at grazing angles, where the gloss reflects
        all.

    Source:
        One lobe beside another as fitted to measured reflectance by A. Ngan, F. Durand
        and W. Matusik, "Experimental Analysis of BRDF Models", EGSR 2005,
        https://doi.org/10.2312/EGWR/EGSR05/117-126

    Raises:
        ValueError: Parts with different numbers of channels.
    """

    first: AbstractBRDF = eqx.field(default_factory=Lambert)
    second: AbstractBRDF = eqx.field(default_factory=GGXLobe)

    reciprocal: ClassVar[Any] = OfBothParts()
    isotropic: ClassVar[Any] = OfBothParts()
    energy_conserving: ClassVar[bool] = False

    def __check_init__(self) -> None:
        """Refuse parts that do not have the same channels."""
        if self.first.channels != self.second.channels:
            raise ValueError(
                "Both parts of a sum must have the same number of channels, but "
                f"`first` has {self.first.channels} and `second` "
                f"{self.second.channels}."
            )

    @property
    def diffuse_reflectance(self) -> Spectrum:
        """That of both parts together."""
        return self.first.diffuse_reflectance + self.second.diffuse_reflectance

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        return self.first.evaluate(wi, wo) + self.second.evaluate(wi, wo)
