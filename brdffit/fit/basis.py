r"""Rows of a fit: what its linear parameters multiply, and how that changes.

With the other parameters held, $f_r = C + \sum_j a_j B_j$ in the linear parameters
$a_j$ of one channel. A pass over the samples evaluates the scalars $C$ and $B_j$ and
their derivatives in the nonlinear parameters, once for all channels that share those.
Derivatives are forward-mode and exact: a derivative along a parameter in which $f_r$ is
affine *is* its basis function.
"""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from brdffit.fit.blocks import Blocks
from brdffit.fit.loss import Loss
from brdffit.fit.residual import Residual
from brdffit.fit.transforms import Layout, to_natural
from brdffit.models import AbstractBRDF
from brdffit.parameters import replace, values
from brdffit.types import AnyArray


class Problem(eqx.Module):
    """One fit: the model, the samples, and what is asked of the parameters.

    Attributes:
        channels: The model cut into channels: leaves with a leading channel axis.
        blocks: The samples.
        lower, upper: Bounds of all parameters, in solver coordinates.
        prior_mean: Where a prior expects each parameter, in its own unit.
        prior_weight: What the square of a distance from there costs, doubled.
        spread: Size of a residual of unit weight, from which a loss tells outliers.
        layout: Where each parameter stands.
        residual: What is compared.
        loss: How much a large residual counts; None for its square.
    """

    channels: AbstractBRDF
    blocks: Blocks
    lower: Float[AnyArray, " n"]
    upper: Float[AnyArray, " n"]
    prior_mean: Float[AnyArray, " n"]
    prior_weight: Float[AnyArray, " n"]
    spread: Float[AnyArray, ""]
    layout: Layout = eqx.field(static=True)
    residual: Residual = eqx.field(static=True)
    loss: Loss | None = eqx.field(static=True, default=None)

    @property
    def projected(self) -> bool:
        """True when the linear parameters can be eliminated."""
        return self.residual.affine and self.loss is None

    @property
    def nonlinear_places(self) -> np.ndarray:
        """Places of the nonlinear parameters in the vector of all."""
        places = self.layout.places
        return np.array([p for n in self.layout.nonlinear for p in places[n]], int)


def _under_light(brdf: AbstractBRDF, wi, wo):
    """``f_r (place)`` of a model of one channel, directions ``(3, place)``."""
    return jax.vmap(brdf.evaluate, in_axes=(1, 1))(wi, wo)[..., 0]


def _under_ambient(brdf: AbstractBRDF):
    """Diffuse reflectance ``(1,)`` of a model of one channel."""
    return brdf.diffuse_reflectance


@partial(jax.jit, static_argnums=(0, 1))
def _reflected(layout: Layout, under, channel: AbstractBRDF, linear, natural, *towards):
    """What one channel reflects; traced once, differentiated often."""
    found = dict(zip(layout.nonlinear, natural, strict=True))
    found |= dict(zip(layout.linear, linear, strict=True))
    shapes = {name: value.shape for name, value in values(channel).items()}
    brdf = replace(channel, {n: v.reshape(shapes[n]) for n, v in found.items()})
    return under(brdf, *towards)


def _channel_rows(problem: Problem, channel, x, derivatives: bool, under, *towards):
    """Rows ``C, B_1, ..`` (and their derivatives) of one channel.

    ``x`` are the solver coordinates of the nonlinear parameters that the channel sees,
    in the order of the layout. Returns rows ``(place)``: first the constant and the
    basis functions, then the derivatives of all of them along each nonlinear parameter
    in turn.
    """
    layout = problem.layout
    places = tuple(layout.channel_places(layout.nonlinear)[0].tolist())
    dtype = problem.blocks.wo.dtype
    zero = jnp.zeros(len(layout.linear), dtype)
    each = jnp.eye(len(layout.linear), dtype=dtype)

    def basis(x):
        # cast after the map: bounds hold to the last digit of the data's precision
        natural = to_natural(layout, x, places).astype(dtype) if places else zero[:0]

        def reflected(linear):
            return _reflected(layout, under, channel, linear, natural, *towards)

        value, push = jax.linearize(reflected, zero)
        return [row.astype(dtype) for row in (value, *(push(e) for e in each))]

    if not derivatives or not places:
        return basis(x)
    # what the rows have in common is worked out once for all of them
    found, along = jax.linearize(basis, x)
    slopes = [row for e in jnp.eye(len(places), dtype=x.dtype) for row in along(e)]
    return [*found, *slopes]


def rows(problem: Problem, x, block, derivatives: bool):
    """Rows of all channels, summed over lights: ``(channel or 1, rows, place)``."""
    layout = problem.layout
    seen = x[local(problem)]

    def weighted(weight, under, *towards):
        def one(channel, x):
            return _channel_rows(problem, channel, x, derivatives, under, *towards)

        if layout.separate:
            found = jax.vmap(one)(problem.channels, seen)
        else:
            first = jax.tree.map(lambda leaf: leaf[0], problem.channels)
            found = [row[None] for row in one(first, seen[0])]
        return [row * weight for row in found]

    def of_light(i):
        light = block.lights.at(i)
        return weighted(light.weight, _under_light, light.wi, block.wo)

    def add_light(i, total):
        return jax.tree.map(jnp.add, total, of_light(i))

    total = of_light(block.first)
    if block.several:
        end = block.first + block.lit
        total = jax.lax.fori_loop(block.first + 1, end, add_light, total)
    if block.ambient is not None:
        ambient = weighted(block.ambient, _under_ambient)
        total = jax.tree.map(jnp.add, total, ambient)
    return jnp.stack(total, axis=1)


def mixed(linear: Array, basis: Array) -> Array:
    """``C + sum of a_j B_j`` over the last but one axis, for each channel."""
    ones = jnp.ones((linear.shape[0], 1))
    combination = jnp.concatenate([ones, linear], axis=1).astype(basis.dtype)
    return jnp.einsum("cj,c...jp->c...p", combination, basis)


def predicted(problem: Problem, x: Array, block: Blocks) -> Array:
    """Values ``(channel, place)`` of a block under all parameters ``x``."""
    layout = problem.layout
    basis = rows(problem, x[problem.nonlinear_places], block, False)
    basis = jnp.broadcast_to(basis, (layout.channels, *basis.shape[1:]))
    return mixed(x[layout.channel_places(layout.linear)], basis)


def transform_in(block: Blocks, residual: Residual):
    """The transform of a residual on values ``(channel, place)`` of a block."""
    cosines = jnp.asarray(block.cos_i)[None], jnp.asarray(block.cos_o)[None]
    return lambda value: residual.transform(value, *cosines)


def local(problem: Problem) -> np.ndarray:
    """Index ``(channel, m)`` of each channel's nonlinear parameters among all."""
    of_place = {place: i for i, place in enumerate(problem.nonlinear_places)}
    seen = problem.layout.channel_places(problem.layout.nonlinear)
    return np.vectorize(of_place.get, otypes=[int])(seen)


def over_blocks(problem: Problem, add, start):
    """Sum ``add(block)`` over the blocks that hold samples, in double precision."""
    blocks = problem.blocks

    def body(i, total):
        part = add(blocks.at(i))
        return jax.tree.map(lambda t, p: t + p.astype(t.dtype), total, part)

    return jax.lax.fori_loop(0, blocks.count, body, start)
