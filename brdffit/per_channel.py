"""A model whose channels have nothing in common but their form."""

from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp

from brdffit.models import AbstractBRDF
from brdffit.types import Direction, Spectrum


class PerChannel(AbstractBRDF):
    r"""One model of one channel for each channel.

    $$f_r[c] = f_c$$

    So a value that a model shares between its channels, such as the width of a lobe,
    may differ between them: light of a longer wavelength sees a smoother surface.

    Attributes:
        parts: Models of one channel, all of the same kind.

    Raises:
        ValueError: No part, or a part with several channels or of another kind.
    """

    parts: tuple[AbstractBRDF, ...]

    reciprocal: ClassVar[bool] = False
    energy_conserving: ClassVar[bool] = False

    def __check_init__(self) -> None:
        """Refuse parts that cannot be stacked."""
        kinds = {jax.tree.structure(part) for part in self.parts}
        if len(kinds) != 1 or any(part.channels != 1 for part in self.parts):
            raise ValueError(
                "`parts` must hold one or more models of the same kind and of one "
                "channel each, but does not."
            )

    @property
    def channels(self) -> int:
        """Number of channels of ``f_r``."""
        return len(self.parts)

    def lobe_axis(self, wi: Direction) -> Direction | None:
        """That of the first part; all are of one kind."""
        return self.parts[0].lobe_axis(wi)

    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        """The value of each part."""
        stacked = jax.tree.map(lambda *leaves: jnp.stack(leaves), *self.parts)
        return eqx.filter_vmap(lambda part: part.evaluate(wi, wo)[0])(stacked)
