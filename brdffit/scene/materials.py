"""Ideal mirror and glass: materials that reflect and refract in single directions.

They are no BRDFs, which are finite functions of two directions, but what is seen in
them is followed by rays.
"""

from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from brdffit.microfacet import fresnel
from brdffit.scene import values

Cosines = Float[Array, " ray"]
Shares = Float[Array, "ray channel"]


def _refractive(key: str, value: Any) -> Float[Array, "..."]:
    return jnp.asarray(values.spectrum(key, value), float)


class Mirror(eqx.Module):
    """A smooth metal, with the exact Fresnel reflectance of a conductor.

    Attributes:
        eta, k: Real and imaginary refractive index, a number for all channels or one
            for each. Without ``k`` the mirror reflects all light at every angle.
        specular: Factor of the reflectance, at most 1.

    Raises:
        ValueError: An index is negative, ``eta`` is 0, ``specular`` is above 1, or they
            differ in their number of channels.
    """

    eta: Float[Array, "..."] = eqx.field(
        default=1.0, converter=partial(_refractive, "eta")
    )
    k: Float[Array, "..."] | None = eqx.field(
        default=None,
        converter=lambda value: None if value is None else _refractive("k", value),
    )
    specular: Float[Array, "..."] = eqx.field(
        default=1.0, converter=partial(_refractive, "specular")
    )

    def __check_init__(self) -> None:
        """Refuse an index that no metal has."""
        if not (self.eta > 0).all():
            raise ValueError(f"`eta` must be above 0, but is {self.eta.tolist()}.")
        if not (self.specular <= 1).all():
            raise ValueError(
                f"`specular` must not be above 1, but is {self.specular.tolist()}."
            )
        if len(sizes := self._sizes) > 1:
            raise ValueError(
                "`eta`, `k` and `specular` must have the same number of channels, but "
                f"have {', '.join(map(str, sorted(sizes)))}."
            )

    @property
    def channels(self) -> int | None:
        """Number of channels, or None when each value holds for all."""
        return next(iter(self._sizes), None)

    @property
    def _sizes(self) -> set[int]:
        given = (self.eta, self.k, self.specular)
        return {value.size for value in given if value is not None and value.ndim}

    def reflected(self, cos_theta: Cosines, channels: int) -> Shares:
        """Share of the light that is reflected, per ray and channel."""
        specular = jnp.broadcast_to(self.specular, channels)
        if self.k is None:
            return jnp.broadcast_to(specular, (cos_theta.shape[0], channels))
        eta, k = (jnp.broadcast_to(index, channels) for index in (self.eta, self.k))
        each = jax.vmap(fresnel.conductor, (0, None, None))
        return specular[None] * each(cos_theta, eta, k)


class Glass(eqx.Module):
    """A smooth, clear dielectric, with the exact Fresnel reflectance.

    Attributes:
        eta: Refractive index over that of the surroundings, above 0 and not 1; all
            channels are refracted alike.

    Raises:
        ValueError: The index is out of range.
    """

    eta: Float[Array, ""] = eqx.field(
        default=1.5,
        converter=lambda value: jnp.asarray(_index(value), float),
    )

    def reflected(self, cos_theta: Cosines, inside: Float[Array, " ray"]) -> Cosines:
        """Share of the light that is reflected; all of it beyond the critical angle.

        Args:
            cos_theta: Cosine of the angle of incidence.
            inside: 1 where the ray comes from within the glass, 0 elsewhere.
        """
        relative = jnp.where(inside > 0, 1 / self.eta, self.eta)
        return jax.vmap(fresnel.dielectric)(cos_theta, relative)


def _index(value: Any) -> float:
    """A relative index of refraction that changes the way of light."""
    if (index := values.positive("eta", value)) == 1:
        raise ValueError("`eta` must not be 1, because such glass is not there.")
    return index


SMOOTH: dict[str, Any] = {"mirror": Mirror, "glass": Glass}
"""Smooth materials by the name that a scene calls them."""
