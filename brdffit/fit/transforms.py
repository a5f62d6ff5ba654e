"""Between the parameters of a model and the vectors that a solver moves in.

Applied once, around the model: no model and no residual knows about it. A logarithmic
parameter moves as ``log(p)``, or ``log(1 + p)`` where 0 is legal; the others as they
are. The maps are monotone, so an interval stays an interval.
"""

import dataclasses
from collections.abc import Sequence
from functools import cached_property

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from brdffit.models import AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import Parameter, parameters, registry_name, replace, values
from brdffit.per_channel import PerChannel
from brdffit.types import AnyArray


@dataclasses.dataclass(frozen=True)
class Layout:
    """Where each parameter of a model stands in the vector of all of them.

    ``entries`` are the parameters in the order of the model's fields; a spectral one
    takes one place per channel.
    """

    entries: tuple[tuple[str, Parameter], ...]
    channels: int
    separate: bool  # the basis functions differ between channels

    @classmethod
    def of(
        cls,
        brdf: AbstractBRDF,
        tied: Sequence[str] = (),
        per_channel: Sequence[str] = (),
    ) -> "Layout":
        """Layout of the parameters of a model, for its own number of channels.

        Args:
            brdf: The model.
            tied: Spectral parameters that are to have one value in all channels.
            per_channel: Shared parameters that are to have a value in each.

        Raises:
            ValueError: A name is unknown, or the parameter is so already.
        """
        known = parameters(brdf)
        current = values(brdf)
        sizes = [current[name].shape[0] for name, p in known.items() if p.spectral]
        for names, spectral in ((tied, False), (per_channel, True)):
            for name in names:
                if look_up(known, name, "Parameter").spectral == spectral:
                    raise ValueError(
                        f"Parameter `{name}` of `{registry_name(brdf)}` has "
                        f"{'a value in each channel' if spectral else 'one value'} "
                        "already."
                    )
                known[name] = dataclasses.replace(known[name], spectral=spectral)
        shared_leaves = {id(current[name]) for name in known}
        extra = [a for a in jax.tree.leaves(brdf) if id(a) not in shared_leaves]
        nonlinear = [p for p in known.values() if p.spectral and not p.linear]
        return cls(
            entries=tuple(known.items()),
            channels=sizes[0] if sizes else 1,
            separate=bool(nonlinear or any(a.ndim for a in extra)),
        )

    @cached_property
    def places(self) -> dict[str, tuple[int, ...]]:
        """Places of each parameter in the vector."""
        found, place = {}, 0
        for name, known in self.entries:
            size = self.channels if known.spectral else 1
            found[name] = tuple(range(place, place + size))
            place += size
        return found

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """One name per place: ``alpha``, ``diffuse[0]`` for one of several channels."""
        return tuple(
            name if len(places) == 1 else f"{name}[{channel}]"
            for name, places in self.places.items()
            for channel in range(len(places))
        )

    @cached_property
    def known(self) -> tuple[Parameter, ...]:
        """What is known about the parameter at each place."""
        return tuple(p for name, p in self.entries for _ in self.places[name])

    @cached_property
    def linear(self) -> tuple[str, ...]:
        """Parameters in which every channel is affine on its own."""
        return tuple(name for name, p in self.entries if p.linear and p.spectral)

    @cached_property
    def nonlinear(self) -> tuple[str, ...]:
        """All other parameters."""
        return tuple(name for name, _ in self.entries if name not in self.linear)

    def channel_places(self, names: tuple[str, ...]) -> np.ndarray:
        """Places ``(channels, len(names))`` that one channel sees of the named ones."""
        seen = [
            [
                self.places[name][c if len(self.places[name]) > 1 else 0]
                for name in names
            ]
            for c in range(self.channels)
        ]
        return np.array(seen, dtype=int).reshape(self.channels, len(names))


def to_solver(layout: Layout, natural: np.ndarray) -> np.ndarray:
    """Solver coordinates of a vector of parameter values."""
    pairs = zip(natural, layout.known, strict=True)
    return np.array([_forward(p)(value) for value, p in pairs])


def to_natural(layout: Layout, x: Array, places: tuple[int, ...]) -> Array:
    """Parameter values of solver coordinates ``x`` that stand at ``places``."""
    inverse = [_inverse(layout.known[place]) for place in places]
    return jnp.stack([f(x[..., i]) for i, f in enumerate(inverse)], axis=-1)


def _forward(known: Parameter):
    if not known.logarithmic:
        return np.asarray
    return np.log if known.lower > 0 else np.log1p


def _inverse(known: Parameter):
    if not known.logarithmic:
        return lambda x: x
    return jnp.exp if known.lower > 0 else jnp.expm1


def bounds(layout: Layout) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper bounds of all places, in solver coordinates."""
    return (
        to_solver(layout, np.array([p.lower for p in layout.known])),
        to_solver(layout, np.array([p.upper for p in layout.known])),
    )


def pack(layout: Layout, brdf: AbstractBRDF) -> np.ndarray:
    """Parameter values of a model as one vector; of tied ones the mean."""
    current = values(brdf)
    return np.concatenate(
        [
            np.broadcast_to(current[name], layout.channels)
            if known.spectral
            else np.mean(current[name], keepdims=True).ravel()
            for name, known in layout.entries
        ]
    ).astype(float)


def unpack(layout: Layout, brdf: AbstractBRDF, natural: AnyArray) -> AbstractBRDF:
    """The model with its parameters taken from one vector, of numpy or of JAX."""
    found = {
        name: natural[np.array(places)] if known.spectral else natural[places[0]]
        for (name, known), places in zip(
            layout.entries, layout.places.values(), strict=True
        )
    }
    current = values(brdf)
    if all(found[name].ndim <= current[name].ndim for name in found):
        for name in found:
            if found[name].ndim < current[name].ndim:  # tied
                found[name] = found[name] * np.ones(current[name].shape)
        return replace(brdf, found)
    parts = []
    for c in range(layout.channels):
        part = jax.tree.map(
            lambda leaf, c=c: jnp.asarray(leaf[c]), channel_models(brdf)
        )
        own = {n: v[c] if v.ndim else v for n, v in found.items()}
        shapes = {n: v.shape for n, v in values(part).items()}
        parts.append(
            replace(
                part, {n: jnp.asarray(v).reshape(shapes[n]) for n, v in own.items()}
            )
        )
    return PerChannel(tuple(parts))


def channel_models(brdf: AbstractBRDF) -> AbstractBRDF:
    """The model cut into its channels, stacked along a new leading axis.

    A part without a channel is repeated, so that one ``vmap`` runs over channels.
    """
    channels = Layout.of(brdf).channels

    def cut(leaf):
        whole = np.asarray(leaf)
        return (
            np.broadcast_to(whole, (channels,)) if whole.ndim == 0 else whole[:, None]
        )

    return jax.tree.map(cut, eqx.filter(brdf, eqx.is_array))
