"""Fresnel's exact reflectance, or Schlick's approximation of it."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from brdffit.effects.decision import Decision, View, not_called_for, operations
from brdffit.effects.worst import extremes
from brdffit.microfacet import fresnel
from brdffit.models import (
    GGX,
    ConductorGGX,
    DielectricGGX,
    GGXLobe,
    Lambert,
)
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import registry_name, values

NAME = "exact_fresnel"
ANGLES = np.radians(np.arange(0.0, 85.5, 0.5))


def decide(view: View) -> Decision:
    """Called for when ``k > 0``, or Schlick is off by more than the tolerance.

    The error is the largest difference of the two reflectances up to 85 degrees. No
    model is changed unless the user asks for it.
    """
    brdf = view.brdf
    if brdf is None:
        return not_called_for(NAME, "the BRDF is not known yet")
    name, known = registry_name(brdf), _by_name(brdf)
    if "eta" not in known and "f0" not in known:
        return not_called_for(NAME, f"{name} has no Fresnel factor")
    error = max(
        _error(_by_name(each)) for each in extremes(brdf, view.within, linear=True)
    )
    cost = operations(
        partial(fresnel.conductor, jnp.ones(())),
        jnp.ones(view.channels),
        jnp.ones(view.channels),
    )
    if "eta" in known:
        why = f"{name} has it; Schlick would be off by {error:.2g}"
        return Decision(NAME, True, why, error, cost, True)
    why = f"{name} has Schlick's, off by {error:.2g} from glass of the same f0"
    if isinstance(brdf, GGX | GGXLobe):
        why += "; --with exact_fresnel renders that"
    # a model is what it is: only the user puts another in its place
    return Decision(NAME, False, why, error, cost, False)


def added(brdf: AbstractBRDF) -> AbstractBRDF:
    """The model with Fresnel's factor for glass of the same reflectance at the normal.

    Raises:
        ValueError: There is none in the catalogue.
    """
    if "eta" in _by_name(brdf):
        return brdf
    if isinstance(brdf, GGX | GGXLobe):
        root = np.sqrt(np.minimum(np.asarray(brdf.f0, np.float64), 0.999))
        lobe = ConductorGGX(
            specular=jnp.ones_like(brdf.f0),
            alpha=brdf.alpha,
            eta=jnp.asarray((1 + root) / (1 - root), brdf.f0.dtype),
            k=jnp.zeros_like(brdf.f0),
            separable=brdf.separable,
        )
        return Lambert(albedo=brdf.diffuse) + lobe if isinstance(brdf, GGX) else lobe
    raise ValueError(
        f"Effect `{NAME}` cannot be added to `{registry_name(brdf)}`: no model in the "
        "catalogue is the same with it."
    )


def removed(brdf: AbstractBRDF) -> AbstractBRDF:
    """The model with Schlick's approximation.

    Raises:
        ValueError: There is none in the catalogue.
    """
    if "eta" not in _by_name(brdf):
        return brdf
    if isinstance(brdf, ConductorGGX | DielectricGGX):
        k = brdf.k if isinstance(brdf, ConductorGGX) else 0.0
        f0 = ((brdf.eta - 1) ** 2 + k**2) / ((brdf.eta + 1) ** 2 + k**2)
        return GGXLobe(
            f0=brdf.specular * f0, alpha=brdf.alpha, separable=brdf.separable
        )
    raise ValueError(
        f"Effect `{NAME}` cannot be taken from `{registry_name(brdf)}`: no model in "
        "the catalogue is the same without it."
    )


def _by_name(brdf: AbstractBRDF) -> dict[str, jax.Array]:
    return {name.rpartition(".")[2]: value for name, value in values(brdf).items()}


def _error(known) -> float:
    """Largest difference of Schlick's reflectance from the exact one."""
    if "eta" in known:
        eta = np.atleast_1d(np.asarray(known["eta"], np.float64))
        k = np.broadcast_to(np.asarray(known.get("k", 0.0), np.float64), eta.shape)
    else:
        f0 = np.atleast_1d(np.asarray(known["f0"], np.float64))
        root = np.sqrt(np.minimum(f0, 0.999))
        eta, k = (1 + root) / (1 - root), np.zeros_like(f0)
    cosine = np.cos(ANGLES)
    with jax.enable_x64(True):
        return float(_difference(cosine, eta, k))


@eqx.filter_jit
def _difference(cosine, eta, k):
    f0 = ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)

    def at(cosine):
        exact = fresnel.conductor(cosine, eta, k)
        return jnp.abs(exact - fresnel.schlick(cosine, f0))

    return jnp.max(jax.vmap(at)(cosine))
