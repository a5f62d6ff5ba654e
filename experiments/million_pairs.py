"""Is a value or a derivative not finite among a million random pairs of directions?

Every pair has its own parameters, drawn from the whole legal interval, each with the
chance of one in eight at either of its ends. Directions are even over the sphere, or
lie between 1e-6 rad and a right angle above the horizon with equal ratios of height
equally likely, or are the mirror image or the reverse of one another, exactly or
nearly.
Value, derivatives by parameters and gradients by both directions are in float32. The
largest of each tells how far it is from where float32 ends. Values below 0 are counted
too, those that rounding explains apart from others.
"""

import sys

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.models import MODELS
from brdffit.parameters import parameters, replace, spectral_fields
from brdffit.plots.style import COLOURS, new_figure
from experiments.record import RESULTS, Record, styled

SEED = 20240607
BATCH, BATCHES = 2**17, 8
AT_AN_END = 1 / 8  # chance of each end of an interval
LOWEST = 1e-6  # rad above the horizon
SMALLEST = 1e-4  # of a logarithmic interval that begins at 0
ROUNDING = 1e-6  # of a value below 0 that rounding explains
SKIPPED = ("sum",)
MARKS = {
    "largest_value": ("o", "value"),
    "largest_by_parameters": ("s", "derivative by a parameter"),
    "largest_by_directions": ("^", "gradient by a direction"),
}


def even(key, count):
    """Directions even over the whole sphere."""
    w = jax.random.normal(key, (count, 3))
    return w / jnp.linalg.norm(w, axis=1, keepdims=True)


def low(key, count):
    """Directions above the horizon, as often within one decade as within the next."""
    height, turn = jax.random.uniform(key, (2, count))
    z = jnp.sin(LOWEST * (jnp.pi / 2 / LOWEST) ** height)
    phi = 2 * jnp.pi * turn
    across = jnp.sqrt(1 - z * z)
    return jnp.stack([across * jnp.cos(phi), across * jnp.sin(phi), z], axis=1)


def pairs(key, count):
    """A fifth each: even, low, mirror images, reversed, and one of these nearly."""
    keys = jax.random.split(key, 6)
    wi = jnp.where(
        jax.random.bernoulli(keys[0], 0.5, (count, 1)),
        even(keys[1], count),
        low(keys[2], count),
    )
    mirrored = wi * jnp.array([-1.0, -1.0, 1.0])
    shift, scale = jax.random.normal(keys[3], (count, 4)), jnp.array([1, 1, 0.1])
    near = mirrored + shift[:, :3] * scale * 10 ** (-4 + 2 * shift[:, 3:])
    near = near / jnp.linalg.norm(near, axis=1, keepdims=True)
    kinds = jnp.stack([even(keys[4], count), low(keys[5], count), mirrored, wi, near])
    kind = jnp.arange(count) % len(kinds)
    return wi, kinds[kind, jnp.arange(count)]


def parameter_values(key, known, count):
    """Legal values, many at the ends."""
    choice, inside = jax.random.uniform(key, (2, count))
    low, high = known.lower, known.upper
    if known.logarithmic:
        start = max(low, SMALLEST)
        drawn = start * (high / start) ** inside
    else:
        drawn = low + (high - low) * inside
    drawn = jnp.where(choice < AT_AN_END, low, drawn)
    return jnp.where(choice > 1 - AT_AN_END, high, drawn)


def counter(name):
    """Compiled: pairs, of which both above the horizon, and how many not finite."""
    spectral, known = spectral_fields(MODELS[name]), parameters(MODELS[name])
    brdf = MODELS[name](**{n: [0.5] for n, many in spectral.items() if many})

    def value(chosen, wi, wo):
        shaped = {n: jnp.reshape(x, (1,) * spectral[n]) for n, x in chosen.items()}
        return replace(brdf, shaped)(wi, wo)[0]

    @jax.jit
    def count(key):
        keys = jax.random.split(key, 1 + len(known))
        wi, wo = pairs(keys[0], BATCH)
        chosen = {
            p: parameter_values(k, known[p], BATCH)
            for p, k in zip(known, keys[1:], strict=True)
        }
        f_r, (by, to_wi, to_wo) = jax.vmap(jax.value_and_grad(value, (0, 1, 2)))(
            chosen, wi, wo
        )
        by = jnp.stack(list(by.values()), axis=1)
        to = jnp.concatenate([to_wi, to_wo], axis=1)
        return {
            "above_horizon": jnp.sum((wi[:, 2] > 0) & (wo[:, 2] > 0)),
            "value_not_finite": jnp.sum(~jnp.isfinite(f_r)),
            "value_below_0": jnp.sum(f_r < -ROUNDING),
            "value_below_0_by_rounding": jnp.sum((f_r < 0) & (f_r >= -ROUNDING)),
            "by_parameters_not_finite": jnp.sum(~jnp.isfinite(by).all(axis=1)),
            "by_directions_not_finite": jnp.sum(~jnp.isfinite(to).all(axis=1)),
            "largest_value": jnp.max(jnp.abs(f_r)),
            "largest_by_parameters": jnp.max(jnp.abs(by)),
            "largest_by_directions": jnp.max(jnp.abs(to)),
        }

    return count


def survey(name, batches):
    """Counts and largest numbers of one model."""
    count = counter(name)
    found = [count(key) for key in jax.random.split(jax.random.key(SEED), batches)]
    row = {"model": name, "pairs": batches * BATCH}
    for what in sorted(found[0]):
        numbers = [float(each[what]) for each in found]
        row[what] = max(numbers) if what in MARKS else int(sum(numbers))
    return row


@styled
def chart(rows):
    """The largest numbers that any pair gave."""
    figure = new_figure(7.0, 1.2 + 0.2 * len(rows))
    axes = figure.subplots()
    names = [row["model"] for row in rows]
    for (what, (mark, label)), colour in zip(MARKS.items(), COLOURS, strict=False):
        numbers = [row[what] for row in rows]
        axes.plot(numbers, names, mark, label=label, color=colour, markersize=5)
    end = float(np.finfo(np.float32).max)
    axes.axvline(end, color="black", linewidth=0.8)
    axes.text(end / 3, 0, "float32 ends", rotation=90, ha="right", va="top", size=7)
    axes.set(xscale="log", ylim=(len(rows) - 0.4, -0.6))
    axes.set_xlabel("largest magnitude (values and gradients in 1/sr), log scale")
    figure.legend(loc="outside lower center", ncols=3)
    bad = sum(n for row in rows for key, n in row.items() if key.endswith("_finite"))
    axes.set_title(
        f"{sum(r['pairs'] for r in rows):,} random pairs, {len(rows)} models: "
        f"{bad:,} values or derivatives not finite"
    )
    return figure


def main(folder=RESULTS / "million_pairs", names=None, batches=BATCHES):
    """Count for every model."""
    record = Record(folder, SEED)
    rows = []
    for name in names or sorted(set(MODELS) - set(SKIPPED)):
        rows.append(survey(name, batches))
        print(rows[-1], flush=True)
    record.table(rows)
    record.figure(chart(rows))
    bad = sum(n for row in rows for key, n in row.items() if key.endswith("_finite"))
    record.close(
        finding=f"{bad:,} values or derivatives are not finite, of "
        f"{sum(row['pairs'] for row in rows):,} pairs over {len(rows)} models.",
        lowest=LOWEST,
        at_an_end=AT_AN_END,
    )


if __name__ == "__main__":
    main(names=sys.argv[1:])
