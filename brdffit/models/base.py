"""The interface every reflectance model implements."""

import abc
from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from brdffit.geometry import cos_theta
from brdffit.parameters import (
    as_float,
    broadcast,
    parameters,
    registry_name,
    spectral_fields,
    values,
)
from brdffit.types import Direction, Spectrum

RGB = 3


class AbstractBRDF(eqx.Module):
    """A BRDF ``f_r(wi, wo)`` in 1/sr, *without* the cosine of the incident angle.

    A model is a frozen pytree of its parameters. Subclasses are final and implement
    `evaluate` only; callers write ``brdf(wi, wo)``. Spectral parameters given as plain
    numbers take the channels of the others, and three (RGB) when no other has any.

    Raises:
        ValueError: Spectral parameters with different numbers of channels, or a list
            for a parameter that has one value in all.
    """

    reciprocal: ClassVar[bool]
    energy_conserving: ClassVar[bool]
    isotropic: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Give all spectral parameters the same number of channels."""
        spectral = spectral_fields(self)
        arrays = {name: as_float(getattr(self, name)) for name in spectral}
        for name in spectral:
            if arrays[name].ndim > spectral[name]:
                raise ValueError(
                    f"Parameter `{name}` of `{registry_name(self)}` must be "
                    f"{'a list of numbers' if spectral[name] else 'one number'}, "
                    f"but has shape {arrays[name].shape}."
                )
        sized = {n: a.shape for n, a in arrays.items() if spectral[n] and a.ndim}
        if len(set(sized.values())) > 1:
            raise ValueError(
                f"Spectral parameters of `{registry_name(self)}` must have the same "
                "number of channels, but have "
                f"{', '.join(f'{name} {shape[0]}' for name, shape in sized.items())}."
            )
        channels = next(iter(sized.values()), (RGB,))
        for name, array in arrays.items():
            shape = channels if spectral[name] else ()
            setattr(self, name, broadcast(array, shape))

    @property
    def channels(self) -> int:
        """Number of channels of ``f_r``."""
        known = parameters(self)
        return next(v.shape[-1] for n, v in values(self).items() if known[n].spectral)

    @property
    def diffuse_reflectance(self) -> Spectrum:
        """Reflectance of the diffuse part, as its parameter says; 0 without one."""
        known = values(self)
        for name in ("diffuse", "albedo"):
            if name in known:
                return known[name]
        return jnp.zeros(self.channels)

    def __add__(self, other: "AbstractBRDF") -> "AbstractBRDF":
        """Both models side by side, as a `Sum`."""
        # imported late: a sum is a model, and is built on this interface
        from brdffit.models.sum import Sum

        return Sum(self, other)

    def lobe_axis(self, wi: Direction) -> Direction | None:
        """Direction about which ``f_r(wi, .)`` is round, or None.

        None, for a lobe about the half vector, unless a model says otherwise; rules of
        integration need to know.
        """
        del wi
        return None

    @abc.abstractmethod
    def evaluate(self, wi: Direction, wo: Direction) -> Spectrum:
        """Return ``f_r`` for one pair of directions above the horizon."""

    def __call__(self, wi: Direction, wo: Direction) -> Spectrum:
        """Return ``f_r``, and 0 when either direction is at or below the horizon."""
        visible = (cos_theta(wi) > 0) & (cos_theta(wo) > 0)
        value = self.evaluate(
            jnp.where(visible, wi, jnp.array([0.6, 0.0, 0.8], wi.dtype)),
            jnp.where(visible, wo, jnp.array([0.0, 0.6, 0.8], wo.dtype)),
        )
        return jnp.where(visible, value, 0.0)
