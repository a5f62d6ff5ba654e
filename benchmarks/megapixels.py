"""How many megapixels of a lit sphere are rendered in a second, beside Mitsuba 3?

A sphere of 1024 x 1024 pixels under one directional light in three materials, with all
cores: brdffit's whole `render` (plan, geometry pass, shading, image), its shading alone
of the pixels that see the sphere, and Mitsuba's render of the same sphere with one
sample a pixel by its direct integrator. All take turns, each round in another order.

Mitsuba runs as `llvm_ad_rgb` where LLVM is found and accepted, else as `scalar_rgb`.
The environment variable DRJIT_LIBLLVM_PATH names the library. It has neither Phong nor
Oren-Nayar: its `roughplastic` and `diffuse`, the nearest of its materials, stand there.
"""

import ctypes.util
import os
import random
import subprocess
import sys
import time

import jax
import jax.numpy as jnp
import numpy as np

import brdffit
from benchmarks.record import RESULTS, facts
from brdffit.models import MODELS, ConductorGGX
from brdffit.plots.style import COLOURS, MUTED, entitle, new_figure
from brdffit.render import render, trace
from brdffit.render.shading import compiled_shade
from experiments.record import Record, styled

TOWARDS, TURNS, RESOLUTION = (-0.48, 0.6, 0.64), 15, 1024
RGB = {"eta": [0.2, 0.9, 1.1], "k": [3.9, 2.4, 2.1]}
BRDFS = {
    "phong": MODELS["phong"](),
    "oren_nayar": MODELS["oren_nayar"](),
    "conductor_ggx": ConductorGGX(specular=1.0, alpha=0.3, eta=RGB["eta"], k=RGB["k"]),
}
THEIRS = {
    "phong": {"type": "roughplastic", "distribution": "ggx"},
    "oren_nayar": {"type": "diffuse"},
    "conductor_ggx": {"type": "roughconductor", "distribution": "ggx", "alpha": 0.3}
    | {key: {"type": "rgb", "value": value} for key, value in RGB.items()},
}
WHOLE, SHADING = "brdffit, whole render", "brdffit, shading alone"
VARIANT = "import mitsuba as m; m.set_variant('llvm_ad_rgb'); m.Float([1, 2]) + 1"


def variant() -> str:
    """Mitsuba's fastest variant that starts here; a bad LLVM ends a process."""
    library = ctypes.util.find_library("LLVM-19") or ctypes.util.find_library("LLVM")
    if library:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", library)
    tried = subprocess.run([sys.executable, "-c", VARIANT], capture_output=True)
    return "scalar_rgb" if tried.returncode else "llvm_ad_rgb"


def mitsuba_render(mi, name: str, resolution: int):
    """A function that renders the sphere with Mitsuba and brings the image home."""
    to_world = mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0])
    film = {"type": "hdrfilm", "width": resolution, "height": resolution}
    film |= {"rfilter": {"type": "box"}, "component_format": "float32"}
    direction = [-x for x in TOWARDS]
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0},
            "sensor": {"type": "orthographic", "to_world": to_world, "film": film},
            "light": {"type": "directional", "direction": direction},
            "sphere": {"type": "sphere", "bsdf": THEIRS[name]},
        }
    )
    return lambda: np.array(mi.render(scene, spp=1))


def contestants(name: str, resolution: int) -> tuple[dict, int]:
    """What takes part, by name, and how many pixels see the sphere."""
    import mitsuba as mi  # after DRJIT_LIBLLVM_PATH is set

    brdf = BRDFS[name]
    scene = brdffit.lit_sphere(resolution, (TOWARDS,))
    samples = jax.tree.map(jnp.asarray, trace(scene))
    chosen = variant()
    mi.set_variant(chosen)
    calls = {
        WHOLE: lambda: render(brdf, scene),
        SHADING: lambda: np.asarray(compiled_shade(brdf, samples)),
        f"Mitsuba {chosen}": mitsuba_render(mi, name, resolution),
    }
    return calls, len(samples)


def timed(name: str, resolution: int, turns: int) -> list[dict]:
    """Lines of the table of one material."""
    calls, seen = contestants(name, resolution)
    taken = {who: [] for who in calls}
    for call in calls.values():
        call()  # which compiles
        call()
    order = random.Random(0)
    for _ in range(turns):
        for who in order.sample(list(calls), len(calls)):
            begin = time.perf_counter()
            calls[who]()
            taken[who].append(time.perf_counter() - begin)
    rows = []
    for who, seconds in taken.items():
        low, middle, high = np.quantile(seconds, [0.25, 0.5, 0.75])
        megapixels = (seen if who == SHADING else resolution**2) / 1e6
        rows.append(
            {
                "material": name,
                "contestant": who,
                "megapixels_per_s": float(megapixels / middle),
                "quartiles": f"{megapixels / high:.0f}-{megapixels / low:.0f}",
                "ms": 1e3 * float(middle),
            }
        )
    return rows


def finding(rows: list[dict]) -> str:
    """How fast whole renders are beside Mitsuba's, as a sentence."""
    speed = {(r["material"], r["contestant"]): r["megapixels_per_s"] for r in rows}
    other = rows[-1]["contestant"]
    ratios = [speed[name, WHOLE] / speed[name, other] for name in BRDFS]
    return (
        f"Whole renders of a sphere by brdffit are {min(ratios):.2g} to "
        f"{max(ratios):.2g} times as fast as by {other}"
    )


@styled
def figure(rows: list[dict], resolution: int):
    """Bars of megapixels per second, a group for each material."""
    drawn = new_figure(7.6, 3.8)
    axes = drawn.subplots()
    names = list(dict.fromkeys(row["contestant"] for row in rows))
    colours = (COLOURS[0], COLOURS[1], MUTED)
    for place, (who, colour) in enumerate(zip(names, colours, strict=True)):
        speed = [row["megapixels_per_s"] for row in rows if row["contestant"] == who]
        at = np.arange(len(speed)) + 0.26 * (place - 1)
        bars = axes.bar(at, speed, width=0.24, color=colour, label=who)
        axes.bar_label(bars, fmt="%.0f", size=7)
    told = [f"{name}\n(Mitsuba: {THEIRS[name]['type']})" for name in BRDFS]
    axes.set_xticks(range(len(told)), told)
    axes.set_ylabel("megapixels per second")
    drawn.legend(loc="outside lower center", ncols=3)
    entitle(drawn, f"{finding(rows)}, at {resolution} x {resolution} pixels")
    return drawn


def main(folder=RESULTS / "megapixels", turns=TURNS, resolution=RESOLUTION):
    """Time all materials."""
    record = Record(folder, seed=0)
    rows = [row for name in BRDFS for row in timed(name, resolution, turns)]
    record.table(rows)
    record.figure(figure(rows, resolution))
    record.close(finding=f"{finding(rows)}.", **facts(turns))
    return rows


if __name__ == "__main__":
    main()
