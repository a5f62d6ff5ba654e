r"""What is seen in mirrors and through glass: rays followed to a stated depth.

The rays are followed once, and what happened to each on its way is kept. The share of
light that arrives is worked out from that again and again, so it is differentiable in
the materials; the directions of refracted rays stay those that were followed.

Light refracted from a medium of index $\eta_t$ into one of $\eta_i$ arrives with
$(\eta_i / \eta_t)^2$ of its radiance, which on the way out is undone.

Source:
    T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980,
    with Fresnel's shares in place of constants.
"""

from collections.abc import Callable, Mapping

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from brdffit.effects.decision import Decision, View, not_called_for, operations
from brdffit.scene import Glass, Hits, Mirror
from brdffit.types import AnyArray

NAME = "bounces"
FAINT = 1e-4  # share of light below which a ray is given up

Meet = Callable[[np.ndarray, np.ndarray], Hits]
Smooth = Mapping[int, Mirror | Glass]


def decide(view: View) -> Decision:
    """A scene calls for it when a shape is smooth and there is something to see in it.

    Leaving it out leaves smooth shapes black.
    """
    scene = view.scene
    smooth = smooth_shapes(scene.shapes)
    if not smooth:
        return not_called_for(NAME, "no shape is a mirror or glass")
    if len(scene.shapes) == len(smooth) and scene.probe is None:
        return not_called_for(NAME, "there is nothing to see in mirrors or glass")
    share = np.isin(view.hits.shape, list(smooth)).mean() if len(view.hits.ray) else 0.0
    glass = sum(isinstance(material, Glass) for material in smooth.values())
    rays = 2**scene.depth if glass else scene.depth
    cosine = jnp.ones(1)
    glass_like = Glass()
    of_fresnel = operations(lambda c: glass_like.reflected(c, c), cosine)
    why = (
        f"{share:.0%} of what is seen is smooth, followed to depth {scene.depth} "
        "(error: root of that share; cost: at most)"
    )
    return view.judged(NAME, np.sqrt(share), rays * of_fresnel, why)


def smooth_shapes(shapes) -> dict[int, Mirror | Glass]:
    """The mirrors and glasses among shapes, by index."""
    return {
        index: shape.material
        for index, shape in enumerate(shapes)
        if isinstance(shape.material, Mirror | Glass)
    }


class Path(eqx.Module):
    """What happened to rays on their way from the camera, bounce by bounce.

    Attributes:
        shape: Index of the smooth shape met, -1 where there was none.
        cosine: Of the angle of incidence.
        inside: 1 where the ray came from within.
        reflected: 1 where it went on by reflection, 0 by refraction.
    """

    shape: Float[AnyArray, "ray bounce"]
    cosine: Float[AnyArray, "ray bounce"]
    inside: Float[AnyArray, "ray bounce"]
    reflected: Float[AnyArray, "ray bounce"]

    def take(self, rows: np.ndarray) -> "Path":
        """The paths with these indices."""
        return Path(*(a[rows] for a in self.arrays))

    @property
    def arrays(self) -> tuple[AnyArray, ...]:
        """All that is kept."""
        return self.shape, self.cosine, self.inside, self.reflected

    def longer(self, *happened: np.ndarray, bounce: int) -> "Path":
        """The paths with one more bounce."""
        arrays = [np.array(a) for a in self.arrays]
        for array, new in zip(arrays, happened, strict=True):
            array[:, bounce] = new
        return Path(*arrays)


class Ends(eqx.Module):
    """Where rays end: on a surface that has a BRDF, or in the sky.

    Attributes:
        hits: Points met, their ``ray`` a pixel.
        surface: The way to each of them.
        pixel: Pixel of each ray that meets nothing.
        direction: Where to it goes.
        sky: The way to there.
    """

    hits: Hits
    surface: Path
    pixel: np.ndarray
    direction: np.ndarray
    sky: Path


def follow(
    meet: Meet, first: Hits, missed, normals, smooth: Smooth, depth: int, channels: int
) -> Ends:
    """Follow rays through mirrors and glass.

    Args:
        meet: What rays meet first.
        first: What the rays of the camera meet.
        missed: Pixel and direction of those that meet nothing.
        normals: From hits to the normals that reflect, with their bumps.
        smooth: Material of each smooth shape.
        depth: Number of bounces after which a ray is given up.
        channels: Number of channels of the image.
    """
    pixel, away = missed
    live, path = first, _empty(len(first.ray), depth)
    surfaces, skies = [], [(pixel, away, _empty(len(pixel), depth))]
    for bounce in range(depth + 1):
        is_smooth = np.isin(live.shape, list(smooth))
        rough = np.flatnonzero(~is_smooth)
        surfaces.append((live.take(rough), path.take(rough)))
        rows = np.flatnonzero(is_smooth)
        if bounce == depth or not len(rows):
            break
        live, path = live.take(rows), path.take(rows)
        origin, direction, pixels, path = _on(live, path, normals(live), smooth, bounce)
        bright = _bright(path, smooth, channels)
        origin, direction, pixels = origin[bright], direction[bright], pixels[bright]
        path = path.take(bright)
        live = meet(origin, direction)
        lost = live.missed(len(pixels))
        skies.append((pixels[lost], direction[lost], path.take(lost)))
        path = path.take(live.ray)
        live = live._replace(ray=pixels[live.ray])
    hits = Hits(
        *(np.concatenate(a) for a in zip(*(h for h, _ in surfaces), strict=True))
    )
    return Ends(
        hits,
        _joined([p for _, p in surfaces]),
        np.concatenate([p for p, _, _ in skies]),
        np.concatenate([d for _, d, _ in skies]),
        _joined([p for _, _, p in skies]),
    )


def _on(hits: Hits, path: Path, normal, smooth: Smooth, bounce: int):
    """Rays that leave smooth surfaces: all reflected, those on glass also refracted."""
    cosine = np.clip(-np.einsum("nk,nk->n", normal, hits.direction), 0, 1)
    mirrored = hits.direction + 2 * cosine[:, None] * normal
    inside = hits.inside.astype(float)
    index = hits.shape.astype(float)
    one = np.ones_like(cosine)
    eta = np.ones(len(cosine))
    for shape, material in smooth.items():
        if isinstance(material, Glass):
            here = hits.shape == shape
            relative = np.where(hits.inside, 1 / float(material.eta), material.eta)
            eta = np.where(here, relative, eta)
    glass = [s for s, m in smooth.items() if isinstance(m, Glass)]
    under = 1 - (1 - cosine * cosine) / eta**2
    through = np.flatnonzero(np.isin(hits.shape, glass) & (under > 0))
    forward = cosine / eta - np.sqrt(np.maximum(under, 0))
    refracted = hits.direction / eta[:, None] + forward[:, None] * normal
    direction = np.concatenate([mirrored, refracted[through]])
    origin = np.concatenate([hits.position, hits.position[through]])
    reflected = path.longer(index, cosine, inside, one, bounce=bounce)
    passed = path.longer(index, cosine, inside, 0 * one, bounce=bounce).take(through)
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    pixels = np.concatenate([hits.ray, hits.ray[through]])
    return origin, direction, pixels, _joined([reflected, passed])


def _bright(path: Path, smooth: Smooth, channels: int) -> np.ndarray:
    """Which rays still bring enough light to be followed."""
    count, room = len(path.shape), 64
    while room < count:
        room *= 4
    filled = (np.pad(a, ((0, room - count), (0, 0)), "edge") for a in path.arrays)
    light = np.asarray(_compiled_shares(Path(*filled), smooth, channels))[:count]
    return np.flatnonzero(light.max(axis=1) > FAINT)


def _empty(count: int, depth: int) -> Path:
    nothing = np.zeros((count, depth))
    return Path(nothing - 1, nothing, nothing, nothing)


def _joined(paths: list[Path]) -> Path:
    return Path(
        *(np.concatenate(a) for a in zip(*(path.arrays for path in paths), strict=True))
    )


def shares(path: Path, smooth: Smooth, channels: int) -> Float[Array, "ray channel"]:
    """Share of the radiance at the end of each path that reaches the camera."""
    shape, cosine, inside, reflected = (
        jnp.asarray(array, float) for array in path.arrays
    )
    total = jnp.ones((*shape.shape, channels))
    for index, material in smooth.items():
        here = shape == index
        c = jnp.where(here, cosine, 1.0).ravel()
        if isinstance(material, Mirror):
            share = material.reflected(c, channels).reshape(total.shape)
        else:
            back = material.reflected(c, inside.ravel()).reshape(shape.shape)
            dense = material.eta * material.eta
            spread = jnp.where(inside > 0, dense, 1 / dense)
            share = jnp.where(reflected > 0, back, (1 - back) * spread)[..., None]
        total = jnp.where(here[..., None], share, total)
    return jnp.prod(total, axis=1)


_compiled_shares = eqx.filter_jit(shares)
