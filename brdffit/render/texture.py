"""Surfaces whose parameters vary from texel to texel, under one light after another."""

from collections.abc import Mapping
from typing import NoReturn

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from brdffit.catalogue import from_name
from brdffit.models.base import RGB, AbstractBRDF
from brdffit.names import look_up
from brdffit.parameters import parameters, replace
from brdffit.render.geometry_pass import trace
from brdffit.scene import Scene
from brdffit.types import AnyArray

Maps = Mapping[str, Float[AnyArray, "row column _"]]
Directions = Float[AnyArray, "light 3 _"]


def render_texture(
    model: str | AbstractBRDF, maps: Maps, scene: Scene
) -> Float[np.ndarray, "light row column channel"]:
    """Linear images of a textured surface, each under one light of a scene alone.

    Args:
        model: Name of a model with the channels of the maps, or a BRDF.
        maps: Parameters by name, of the size of the image and with one channel, or one
            for each of the BRDF; those not given are those of the model.
        scene: Camera, surface and its directional or point lights. Pixels that do not
            see the surface are 0.

    Raises:
        ValueError: There is no such model or parameter, a map has another shape, or
            the lights have another number of channels.
    """
    rows, columns = scene.camera.shape
    if isinstance(model, str):
        model = from_name(model, max((m.shape[-1] for m in maps.values()), default=RGB))
    known = parameters(model)
    samples = trace(scene, channels=model.channels)
    pixels = samples.pixels
    assert pixels is not None  # for the type checker
    new = {}
    for name, image in maps.items():
        wanted = model.channels if look_up(known, name, "Parameter").spectral else 1
        if image.shape not in {(rows, columns, wanted), (rows, columns, 1)}:
            _refuse(name, image.shape, (rows, columns, wanted))
        texels = np.asarray(image, np.float32)[pixels.row, pixels.column].T
        new[name] = np.broadcast_to(texels, (wanted, texels.shape[1]))
    wi, weight = (
        np.moveaxis(np.asarray(a), 0, -1) for a in (samples.wi, samples.weight)
    )
    wo = np.broadcast_to(np.asarray(samples.wo).T, wi.shape)
    images = np.zeros((len(wi), rows, columns, model.channels), np.float32)
    shown = np.asarray(shade_texels(model, new, wi, wo, weight))
    images[:, pixels.row, pixels.column] = np.moveaxis(shown, 1, -1)
    return images


@eqx.filter_jit
def shade_texels(
    brdf: AbstractBRDF,
    new: Mapping[str, Float[AnyArray, "_ texel"]],
    wi: Directions,
    wo: Directions,
    weight: Float[AnyArray, "light _ _"],
) -> Float[Array, "light channel texel"]:
    """Values ``f_r weight`` of texels that each have parameters of their own.

    Args:
        brdf: The model; parameters that are not replaced are its own.
        new: Parameters by name, one row, or one for each channel of a spectral one.
        wi: Directions to each light; the last axis is 1 where all texels share them.
        wo: Directions to the viewer, likewise.
        weight: What a unit of ``f_r`` adds, likewise; the second axis is 1 where all
            channels share it.
    """
    known = parameters(brdf)
    own = {n: jnp.asarray(a if known[n].spectral else a[0]) for n, a in new.items()}

    def value(own, wi, wo):
        return replace(brdf, own)(wi, wo)

    of_texel = jax.vmap(value, in_axes=(None, 0, 0))
    count = next((a.shape[-1] for a in new.values()), wi.shape[-1])
    wi, wo = (jnp.broadcast_to(w, (len(wi), 3, count)) for w in (wi, wo))
    return jax.vmap(of_texel, in_axes=(-1, -1, -1), out_axes=-1)(own, wi, wo) * weight


def _refuse(name: str, shape: tuple[int, ...], wanted: tuple[int, ...]) -> NoReturn:
    raise ValueError(
        f"The map of `{name}` must have shape {wanted}, or one channel, but has "
        f"{shape}."
    )
