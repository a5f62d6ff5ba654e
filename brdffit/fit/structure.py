r"""Normal equations of a fit, from what the declarations of a model allow.

With the other parameters held, $f_r = C + \sum_j a_j B_j$ in the linear parameters
$a_j$ of one channel. So a pass over the samples evaluates the scalars $C$ and $B_j$ and
their derivatives in the nonlinear parameters, once for all channels that share those,
and everything a solver needs comes out of one small Gram matrix of these rows and the
data. Derivatives are forward-mode and exact: a derivative along a parameter in which
$f_r$ is affine *is* its basis function.

Two uses of the same rows:

- `projected`: the residual is affine in the value, so the linear parameters are
  eliminated, with their bounds, and the solver sees only the nonlinear ones (variable
  projection, G. Golub and V. Pereyra, SIAM J. Numer. Anal. 10(2), 1973, in the form of
  L. Kaufman, BIT 15, 1975);
- `streamed`: any residual; the solver sees all parameters, and the Jacobian goes
  block by block into the Gram matrix without ever being stored.
"""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from brdffit.fit.blocks import Blocks
from brdffit.fit.quadratic import minimise_in_box, solve_positive
from brdffit.fit.residual import Residual
from brdffit.fit.transforms import Layout, to_natural
from brdffit.models import AbstractBRDF
from brdffit.parameters import replace


class NormalEquations(eqx.Module):
    """Half the sum of squares with its first and (Gauss-Newton) second derivative.

    ``rounding`` is the error that floating point leaves in ``cost``, ``floor`` the
    smallest decrease that the gradient can still promise.
    """

    cost: Float[Array, ""]
    gradient: Float[Array, " n"]
    hessian: Float[Array, "n n"]
    rounding: Float[Array, ""]
    floor: Float[Array, ""]


class Problem(eqx.Module):
    """One fit: the model cut into channels, the samples, the residual, the bounds."""

    channels: AbstractBRDF  # leaves with a leading channel axis
    blocks: Blocks
    lower: Float[Array, " n"]  # of all parameters, in solver coordinates
    upper: Float[Array, " n"]
    layout: Layout = eqx.field(static=True)
    residual: Residual = eqx.field(static=True)

    @property
    def nonlinear_places(self) -> np.ndarray:
        """Places of the nonlinear parameters in the vector of all."""
        places = self.layout.places
        return np.array([p for n in self.layout.nonlinear for p in places[n]], int)


@partial(jax.jit, static_argnums=0)
def _reflectance(layout: Layout, channel: AbstractBRDF, linear, natural, wi, wo):
    """``f_r (light, place)`` of one channel; traced once, differentiated often."""
    spectral = {name: known.spectral for name, known in layout.entries}
    values = {
        name: natural[i : i + 1] if spectral[name] else natural[i]
        for i, name in enumerate(layout.nonlinear)
    }
    values |= {name: linear[i : i + 1] for i, name in enumerate(layout.linear)}
    brdf = replace(channel, values)
    over_places = jax.vmap(brdf.evaluate, in_axes=(1, 1))
    return jax.vmap(over_places, in_axes=(1, None))(wi, wo)[..., 0]


def _channel_rows(problem: Problem, channel, x, block, derivatives: bool):
    """Rows ``C, B_1, ..`` (and their derivatives) of one channel, per light.

    ``x`` are the solver coordinates of the nonlinear parameters that the channel sees,
    in the order of the layout. Returns ``(rows, light, place)``: first the constant and
    the basis functions, then the derivatives of all of them along each nonlinear
    parameter in turn.
    """
    layout = problem.layout
    places = tuple(layout.channel_places(layout.nonlinear)[0].tolist())
    dtype = block.wi.dtype
    zero = jnp.zeros(len(layout.linear), dtype)
    each = jnp.eye(len(layout.linear), dtype=dtype)

    def basis(x):
        # cast after the map: bounds hold to the last digit of the data's precision
        natural = to_natural(layout, x, places).astype(dtype) if places else zero[:0]

        def reflectance(linear):
            return _reflectance(layout, channel, linear, natural, block.wi, block.wo)

        rows = [reflectance(zero)]
        rows += [jax.jvp(reflectance, (zero,), (e,))[1] for e in each]
        return jnp.stack(rows)

    if not derivatives or not places:
        return basis(x)
    along = jnp.eye(len(places), dtype=x.dtype)
    slopes = [jax.jvp(basis, (x,), (e,))[1] for e in along]
    return jnp.concatenate([basis(x), *slopes])


def _rows(problem: Problem, x, block, derivatives: bool):
    """Rows of all channels, summed over lights: ``(channel or 1, rows, place)``."""
    layout = problem.layout
    seen = x[_local(problem)]
    if layout.separate:
        rows = jax.vmap(
            lambda channel, x: _channel_rows(problem, channel, x, block, derivatives)
        )(problem.channels, seen)
    else:
        first = jax.tree.map(lambda leaf: leaf[0], problem.channels)
        rows = _channel_rows(problem, first, seen[0], block, derivatives)[None]
    weight = jnp.moveaxis(block.weight, 1, 0)  # channel or 1, light, place
    return jnp.sum(rows * weight[:, None], axis=2)


def _local(problem: Problem) -> np.ndarray:
    """Index ``(channel, m)`` of each channel's nonlinear parameters among all."""
    of_place = {place: i for i, place in enumerate(problem.nonlinear_places)}
    seen = problem.layout.channel_places(problem.layout.nonlinear)
    return np.vectorize(of_place.get, otypes=[int])(seen)


def _over_blocks(problem: Problem, add, start):
    """Sum ``add(block)`` over the blocks that hold samples, in double precision."""
    blocks = problem.blocks

    def body(i, total):
        def pick(array):
            if array.ndim == 0:  # the count
                return array
            return jax.lax.dynamic_index_in_dim(array, i, keepdims=False)

        part = add(jax.tree.map(pick, blocks))
        return jax.tree.map(lambda t, p: t + p.astype(t.dtype), total, part)

    return jax.lax.fori_loop(0, blocks.count, body, start)


def _gram(rows: Array) -> Array:
    return rows @ jnp.swapaxes(rows, -1, -2)


def _transform(residual: Residual, block: Blocks):
    """The transform of a residual on values ``(channel, place)`` of a block."""
    cosines = jnp.asarray(block.cos_i)[None], jnp.asarray(block.cos_o)[None]
    return lambda value: residual.transform(value, *cosines)


def project(problem: Problem, x: Array, derivatives: bool = True):
    """Normal equations in the nonlinear parameters, the linear ones eliminated.

    Returns:
        The equations, and the linear parameters ``(channel, q)`` that go with ``x``.
    """
    layout = problem.layout
    q, m = len(layout.linear), len(layout.nonlinear)
    count = (1 + q) * (1 + m if derivatives else 1)
    channels = layout.channels
    shared = (
        not layout.separate
        and problem.blocks.weight.shape[2] == problem.blocks.lean.shape[1] == 1
    )

    def add(block):
        rows = _rows(problem, x, block, derivatives)
        if shared:  # one product for all channels
            return _gram(jnp.concatenate([rows[0], block.value]) * block.lean)[None]
        rows = jnp.broadcast_to(rows, (channels, *rows.shape[1:]))
        rows = jnp.concatenate([rows, block.value[:, None]], axis=1)
        return _gram(rows * block.lean[:, None])

    size = (1, count + channels) if shared else (channels, count + 1)
    gram = _over_blocks(problem, add, jnp.zeros((*size, size[1]), jnp.float64))
    if shared:
        own = [np.append(np.arange(count), count + c) for c in range(channels)]
        gram = jnp.stack([gram[0][np.ix_(i, i)] for i in own])

    bounds = layout.channel_places(layout.linear)
    parts, linear = jax.vmap(
        lambda g, low, high: _eliminate(g, low, high, q, m, derivatives)
    )(gram, problem.lower[bounds], problem.upper[bounds])
    eps = 8 * jnp.finfo(problem.blocks.wi.dtype).eps
    energy = jnp.sum(gram[:, -1, -1])
    whole = _assemble(parts, _local(problem), x.shape[0], eps * energy, eps**2 * energy)
    return whole, linear


def _eliminate(gram, lower, upper, q: int, m: int, derivatives: bool):
    """Local normal equations of one channel after its linear parameters are solved."""
    basis = gram[1 : 1 + q, 1 : 1 + q]
    slope = gram[1 : 1 + q, 0] - gram[1 : 1 + q, -1]
    if q:
        linear, free = minimise_in_box(basis, slope, lower, upper)
    else:
        linear, free = jnp.zeros(0), jnp.ones(0, bool)
    combination = jnp.concatenate([jnp.ones(1), linear])
    spread = jnp.zeros(gram.shape[0]).at[: 1 + q].set(combination).at[-1].set(-1.0)
    image = gram @ spread
    cost = jnp.dot(spread, image) / 2
    if not (derivatives and m):
        return (cost, jnp.zeros(m), jnp.zeros((m, m))), linear

    # row i of `tangent`: how the residual changes with nonlinear parameter i
    blocks = gram[1 + q : -1].reshape(m, 1 + q, -1)
    tangent = jnp.einsum("j,mjk->mk", combination, blocks)
    gradient = tangent @ spread
    hessian = jnp.einsum(
        "j,amj->am", combination, tangent[:, 1 + q : -1].reshape(m, m, 1 + q)
    )
    # what elimination leaves of a direction the data do not see is mere rounding
    ridge = 64 * jnp.finfo(gram.dtype).eps * jnp.diag(jnp.diagonal(hessian))
    if q:
        held = jnp.where(free[:, None] & free[None, :], basis, jnp.eye(q))
        cross = tangent[:, 1 : 1 + q] * free[None]
        unit = jax.lax.rsqrt(
            jnp.maximum(jnp.diagonal(held), jnp.finfo(gram.dtype).tiny)
        )
        scaled = held * unit[:, None] * unit[None, :]
        scaled += 8 * jnp.finfo(gram.dtype).eps * jnp.eye(q)
        solved = jax.vmap(solve_positive, (None, 0))(scaled, cross * unit[None])
        hessian -= (cross * unit[None]) @ solved.T
    return (cost, gradient, hessian + ridge), linear


def stream(problem: Problem, x: Array) -> NormalEquations:
    """Normal equations in all parameters, for any residual."""
    layout = problem.layout
    q, m = len(layout.linear), len(layout.nonlinear)
    linear = x[layout.channel_places(layout.linear)]
    size = q + m + 1

    def add(block):
        rows = _rows(problem, x[problem.nonlinear_places], block, True)
        rows = jnp.broadcast_to(rows, (layout.channels, *rows.shape[1:]))
        combination = jnp.concatenate([jnp.ones((layout.channels, 1)), linear], axis=1)
        rows = rows.reshape(layout.channels, 1 + m, 1 + q, -1)
        mixed = jnp.einsum("cj,cmjp->cmp", combination.astype(rows.dtype), rows)

        transform = _transform(problem.residual, block)
        predicted = mixed[:, 0]
        compared, slope = jax.jvp(transform, (predicted,), (jnp.ones_like(predicted),))
        error = compared - block.target
        jacobian = jnp.concatenate([rows[:, 0, 1:], mixed[:, 1:]], axis=1)
        local = jnp.concatenate([jacobian * slope[:, None], error[:, None]], axis=1)
        magnitude = jnp.sum((slope * predicted * block.scale) ** 2)
        return _gram(local * block.scale[:, None]), magnitude

    start = jnp.zeros((layout.channels, size, size), jnp.float64), jnp.zeros(())
    gram, magnitude = _over_blocks(problem, add, start)
    parts = gram[:, -1, -1] / 2, gram[:, :-1, -1], gram[:, :-1, :-1]
    places = layout.channel_places(layout.linear + layout.nonlinear)
    eps = 8 * jnp.finfo(problem.blocks.wi.dtype).eps
    floor = eps**2 * magnitude
    return _assemble(parts, places, x.shape[0], eps * jnp.sum(parts[0]) + floor, floor)


def _assemble(parts, places: np.ndarray, size: int, rounding, floor) -> NormalEquations:
    """Add the equations of all channels where they belong in the whole."""
    cost, gradient, hessian = parts
    whole = jnp.zeros(size).at[places].add(gradient)
    rows, columns = places[:, :, None], places[:, None, :]
    return NormalEquations(
        cost=jnp.sum(cost),
        gradient=whole,
        hessian=jnp.zeros((size, size)).at[rows, columns].add(hessian),
        rounding=rounding,
        floor=floor,
    )


def costs(problem: Problem, x: Array, residuals: tuple[Residual, ...]) -> Array:
    """How far off the parameters are under each residual.

    Values that a residual cannot compare are left out of its sums.

    Returns:
        ``(residual, 3)``: half the weighted sum of squares, the unweighted sum of
        squares, and the number of values in it.
    """
    layout = problem.layout
    linear = x[layout.channel_places(layout.linear)]

    def add(block):
        predicted = _predicted(problem, x, linear, block)
        base = block.lean if block.known_sigma else block.scale
        found = []
        for residual in residuals:
            transform = _transform(residual, block)
            one = jnp.ones_like(block.value)
            target, slope = jax.jvp(transform, (block.value,), (one,))
            use = jnp.broadcast_to(base > 0, predicted.shape) & (slope > 0)
            if residual.positive:
                use &= block.value > 0
            error = jnp.where(use, transform(predicted) - target, 0)
            scale = base / jnp.where(use, slope, 1) if block.known_sigma else base
            tally = (jnp.sum((error * scale) ** 2) / 2, jnp.sum(error**2), jnp.sum(use))
            found.append(jnp.stack(tally))
        return jnp.stack(found)

    return _over_blocks(problem, add, jnp.zeros((len(residuals), 3), jnp.float64))


def _predicted(problem: Problem, x, linear, block):
    rows = _rows(problem, x[problem.nonlinear_places], block, False)
    rows = jnp.broadcast_to(rows, (problem.layout.channels, *rows.shape[1:]))
    combination = jnp.concatenate(
        [jnp.ones((problem.layout.channels, 1)), linear], axis=1
    )
    return jnp.einsum("cj,cjp->cp", combination.astype(rows.dtype), rows)
