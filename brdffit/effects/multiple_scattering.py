"""Light that facets reflect more than once, which most models lose."""

import jax.numpy as jnp
import numpy as np

from brdffit.effects.decision import Decision, View, not_called_for, operations
from brdffit.effects.worst import extremes
from brdffit.microfacet import multiple_scattering
from brdffit.models import GGX, GGXMultiscatter
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import registry_name, values

NAME = "multiple_scattering"
COSINES = np.cos(np.radians([1.0, 30.0, 60.0, 75.0]))


def decide(view: View) -> Decision:
    """Called for when ``1 - E(alpha)`` times F exceeds the tolerance.

    The facets are taken for GGX's. No model is changed unless the user asks for it.
    """
    brdf = view.brdf
    if brdf is None:
        return not_called_for(NAME, "the BRDF is not known yet")
    name = registry_name(brdf)
    cost = operations(
        lambda w: multiple_scattering.kulla_conty(
            w, w, jnp.ones(view.channels), jnp.ones(())
        ),
        np.array([0.0, 0.0, 1.0], np.float32),
    )
    if isinstance(brdf, GGXMultiscatter):
        error = max(_lost(each) for each in extremes(brdf, view.within, linear=True))
        return Decision(NAME, True, f"{name} has it", error, cost, True)
    error = max(_lost(each) for each in extremes(brdf, view.within, linear=True))
    if error == 0:
        return not_called_for(NAME, f"{name} has no facets")
    remedy = (
        "--with multiple_scattering renders ggx_multiscatter instead"
        if type(brdf) is GGX
        else "no other model in the catalogue is the same with it"
    )
    why = f"{name} loses {error:.2g} at most; {remedy}"
    # a model is what it is: only the user puts another in its place
    return Decision(NAME, False, why, error, cost, False)


def added(brdf: AbstractBRDF) -> AbstractBRDF:
    """The model with the light that it loses.

    Raises:
        ValueError: There is none in the catalogue.
    """
    if isinstance(brdf, GGXMultiscatter):
        return brdf
    if type(brdf) is GGX and not brdf.separable:
        return GGXMultiscatter(diffuse=brdf.diffuse, f0=brdf.f0, alpha=brdf.alpha)
    raise ValueError(
        f"Effect `{NAME}` cannot be added to `{registry_name(brdf)}`: no model in the "
        "catalogue is the same with it."
    )


def removed(brdf: AbstractBRDF) -> AbstractBRDF:
    """The model with single scattering only."""
    if isinstance(brdf, GGXMultiscatter):
        return GGX(diffuse=brdf.diffuse, f0=brdf.f0, alpha=brdf.alpha)
    return brdf


def _lost(brdf: AbstractBRDF) -> float:
    """Largest share of light that single scattering loses, over angles to 75 deg."""
    known = {name.rpartition(".")[2]: np.asarray(v) for name, v in values(brdf).items()}
    rough = [float(known[n]) for n in ("alpha", "alpha_x", "alpha_y") if n in known]
    if not rough:
        return 0.0
    alpha = np.full(COSINES.shape, max(rough))
    missing = multiple_scattering.missing(COSINES, alpha)
    return float(missing.max() * _brightest(known))


def _brightest(known) -> float:
    """Largest reflectance at normal incidence among the channels."""
    if "f0" in known:
        f0 = known["f0"]
    elif "eta" in known:
        eta, k = known["eta"], known.get("k", 0.0)
        f0 = ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)
    else:
        f0 = 1.0
    return float(np.max(f0 * known.get("specular", 1.0)))
