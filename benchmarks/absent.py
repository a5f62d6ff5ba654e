"""Does an effect that a scene does not call for cost anything?

A sphere of 256 x 256 pixels without ambient light, shaded by brdffit, beside a program
that was written without a thought of effects. Both get the same samples and are timed
in turns, each round in another order; the answer is the ratio of the two by turns.
"""

import random
import time

import jax
import jax.numpy as jnp
import numpy as np

from benchmarks.measure import use_one_core
from benchmarks.record import RESULTS, facts
from brdffit.compiled import compiled
from brdffit.models import MODELS
from brdffit.plots.style import COLOURS, MUTED, entitle, new_figure
from brdffit.render import shade, trace
from brdffit.scene import Ambient, Directional, Orthographic, Point, Scene, Sphere
from experiments.record import Record, styled

SUN = Directional([-0.48, 0.6, 0.64])
SCENES = {
    "one directional light": (SUN,),
    "ambient light without radiance": (SUN, Ambient(0.0)),
    "point light instead": (Point([-1.0, 1.5, 2.0]),),
}
NAMES = ("phong", "oren_nayar", "conductor_ggx")
TURNS, CALLS, MOST = 41, 10, 1.05


def bare(brdf, samples):
    """Shading as one would write it for a lone sphere."""

    def value(wi, wo, weight):
        return jnp.sum(jax.vmap(brdf, in_axes=(0, None))(wi, wo) * weight, axis=0)

    return jax.vmap(value)(samples.wi, samples.wo, samples.weight)


def seconds(call) -> float:
    """Processor time of one call."""
    begin = time.process_time()
    for _ in range(CALLS):
        jax.block_until_ready(call())
    return (time.process_time() - begin) / CALLS


def ratios(brdf, scene, turns: int) -> np.ndarray:
    """Time with brdffit over that of the bare program, turn by turn."""
    samples = jax.tree.map(jnp.asarray, trace(scene))
    ours, other = compiled(shade), compiled(bare)
    calls = [lambda: ours(brdf, samples), lambda: other(brdf, samples)]
    np.testing.assert_array_equal(*(call() for call in calls))
    order, found = random.Random(0), []
    for _ in range(turns):
        taken = {which: seconds(calls[which]) for which in order.sample([0, 1], 2)}
        found.append(taken[0] / taken[1])
    return np.array(found)


@styled
def figure(rows: list[dict], turns: int):
    """Median ratios with a line over their quartiles, and the limit."""
    drawn = new_figure(6.4, 3.4)
    axes = drawn.subplots()
    for place, row in enumerate(rows):
        ends = [float(end) for end in row["quartiles"].split("-")]
        told = ("quartiles", f"median of {turns} turns") if not place else (None, None)
        axes.plot(ends, (place, place), color=COLOURS[0], linewidth=1, label=told[0])
        axes.plot(
            row["ratio"], place, "o", color=COLOURS[0], markersize=5, label=told[1]
        )
    axes.axvline(MOST, color=MUTED, linestyle="--", label=f"limit {MOST}")
    names = [f"{row['scene']}, {row['model']}" for row in rows]
    axes.set_yticks(range(len(rows)), names)
    axes.invert_yaxis()
    axes.set_xlabel("time with brdffit / time of a program without effects")
    drawn.legend(loc="outside lower center", ncols=3)
    medians = [row["ratio"] for row in rows]
    entitle(
        drawn,
        f"Effects that a scene lacks cost nothing: {min(medians):.2f} to "
        f"{max(medians):.2f} times the time of a program without them",
    )
    return drawn


def main(folder=RESULTS / "absent", turns=TURNS, resolution=256):
    """Time all scenes and models."""
    record = Record(folder, seed=0)
    rows = []
    for told, lights in SCENES.items():
        scene = Scene(Orthographic(resolution), (Sphere(),), lights)
        for name in NAMES:
            found = np.quantile(ratios(MODELS[name](), scene, turns), [0.25, 0.5, 0.75])
            low, middle, high = map(float, found)
            rows.append(
                {
                    "scene": told,
                    "model": name,
                    "ratio": round(middle, 4),
                    "quartiles": f"{low:.3f}-{high:.3f}",
                    "below_1.05": middle < MOST,
                }
            )
            print(*rows[-1].values(), flush=True)
    record.table(rows)
    record.figure(figure(rows, turns))
    record.close(**facts(turns))
    return rows


if __name__ == "__main__":
    use_one_core()
    main()
