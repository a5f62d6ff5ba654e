"""Where does the printed formula of a model fail in float32 or float64, and does ours?

Every model meets 26 hard pairs of directions (normal, mirror, retro, grazing down to
1e-6 rad, on and below the horizon) times hard parameters (both ends of the legal and of
the typical interval of each). Value, derivatives by parameters and gradients by both
directions are compared with the oracle's, which has a hundred digits.

A number is off when it differs by more than 1 %, by more than 20 times what rounding
of the input directions does to the true one, and by more than 1e-7 of the value, or of
1 where the value is smaller. At a kink there is no derivative to compare, only to be
finite. `ggx_multiscatter`, whose oracle takes hours, is compared in float32 alone, with
itself in float64; it and `student_t` have no printed formula.

What is found is counted: by model in `table.csv`, by pair of directions in
`directions.csv`, in a sentence in `run.toml`. Printed formulas lose derivatives at the
normal, at the mirror direction (an arc cosine of 1, an azimuth of nothing), on the
horizon and with a power of 0; values of narrow lobes (1 - cos^2 in a few digits) and of
grazing directions (an arc cosine near a right angle). Ours loses none.

    python -m experiments.stability [--full] [MODEL ...]

All models take 20 minutes, with `--full`; without it two of them are judged.
"""

import itertools
import sys
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from brdffit.models import MODELS
from brdffit.parameters import replace, spectral_fields
from brdffit.plots.style import new_figure
from experiments import textbook
from experiments.hard_cases import SKIPPED, cases, directions, settings
from experiments.record import RESULTS, Record, styled

SOME = ("phong", "oren_nayar")
TRUTH = Path(__file__).parent / "hard_cases_truth.npz"
RELATIVE = 0.01
RATIO = 20  # to the effect of rounding
BACKGROUND = 1e-7
LARGEST = 1e37  # what float32 can hold, with room for a derivative
ROUNDING = {"float32": 2.0**-24, "float64": 2.0**-53}
SHAKES = ((1, 1, -1), (1, -1, 1), (-1, 1, 1), (1, 1, 1))  # signs of a rounding

FINE, GRADIENT_OFF, GRADIENT_LOST, VALUE_OFF, VALUE_LOST = range(5)
MEANING = (
    "right",
    "a derivative off by > 1 %",
    "a derivative not finite",
    "value off by > 1 %",
    "value not finite",
)
# each darker than the one before, in colour and in grey
COLOURS = ("#f4f4f4", "#f0d458", "#e08a2e", "#a8325e", "#1b0c3a")
FORMULAS = ("printed", "ours")
TITLES = {"printed": "as printed", "ours": "as written here"}
PARTS = ("value", "by_parameters", "by_directions")


def ours(name):
    """Our model as a function of its parameters and both directions, one channel."""
    spectral = spectral_fields(MODELS[name])
    brdf = MODELS[name](**{n: [0.5] for n, many in spectral.items() if many})

    def value(chosen, wi, wo):
        shaped = {n: jnp.reshape(x, (1,) * spectral[n]) for n, x in chosen.items()}
        return replace(brdf, shaped)(wi, wo)[0]

    return value


def printed(name):
    """The textbook formula in the same form."""

    def value(chosen, wi, wo):
        return textbook.above_horizon(
            wi, wo, textbook.MODELS[name](wi, wo, **chosen) * 1.0
        )

    return value


def differentiated(function):
    """Compiled for many cases: rows of value, by parameters, by wi, by wo."""
    each = jax.jit(jax.vmap(jax.value_and_grad(function, argnums=(0, 1, 2))))

    def rows(chosen, wi, wo, precision):
        wi, wo = np.asarray(wi, float), np.asarray(wo, float)
        lengths = [np.linalg.norm(w, axis=1, keepdims=True) for w in (wi, wo)]
        if precision == "float64":
            wi, wo = wi / lengths[0], wo / lengths[1]
        with jax.enable_x64(precision == "float64"), np.errstate(over="ignore"):
            value, (by, to_wi, to_wo) = each(
                {p: jnp.asarray(x, precision) for p, x in chosen.items()},
                jnp.asarray(wi, precision),
                jnp.asarray(wo, precision),
            )
            columns = [np.asarray(value), *(np.asarray(by[p]) for p in chosen)]
        return np.column_stack(
            [
                *columns,
                tangential(to_wi, wi) / lengths[0],
                tangential(to_wo, wo) / lengths[1],
            ]
        )

    return rows


def tangential(gradient, w):
    """What is left of a gradient when the length of ``w`` does not matter."""
    gradient = np.asarray(gradient, float)
    with np.errstate(invalid="ignore"):  # of what is not finite nothing is left
        along = np.sum(gradient * w, axis=1, keepdims=True)
        return gradient - w * along / np.sum(w * w, axis=1, keepdims=True)


def spread(rows, chosen, wi, wo):
    """How far each number moves when directions are rounded to float32."""
    at = rows(chosen, wi, wo, "float64")
    moved = np.zeros_like(at)
    for one, other in itertools.product(SHAKES, repeat=2):
        by, to = (ROUNDING["float32"] * np.array(signs) for signs in (one, other))
        shaken = rows(chosen, wi * (1 + by), wo * (1 - to), "float64")
        moved = np.fmax(moved, np.abs(shaken - at))
    return at, moved


def judge(found, exact, moved, precision):
    """For each part: which cases are not finite, and which are off.

    Numbers that float32 cannot hold are not judged.
    """
    moved = moved * (ROUNDING[precision] / ROUNDING["float32"])
    floor = BACKGROUND * np.maximum(1, np.abs(exact[:, :1]))
    parameter_count = exact.shape[1] - 7
    groups = {
        "value": [slice(0, 1)],
        "by_parameters": [slice(n + 1, n + 2) for n in range(parameter_count)],
        "by_directions": [slice(-6, -3), slice(-3, None)],
    }
    verdict = {}
    for part, slices in groups.items():
        lost, off = np.zeros((2, len(found)), bool)
        for columns in slices:
            here, right = found[:, columns], exact[:, columns]
            held = ~(np.abs(right) > LARGEST)
            lost |= (held & ~np.isfinite(here)).any(1)
            size = np.abs(right).max(1, keepdims=True)  # NaN where one is at a kink
            allowed = np.maximum(RELATIVE * size, RATIO * moved[:, columns])
            with np.errstate(invalid="ignore"):  # a kink has no right answer
                wrong = np.abs(here - right) > np.maximum(allowed, floor)
            off |= (held & wrong).any(1)
        verdict[part] = lost, off & ~lost
    return verdict


def severity(verdict):
    """The worst that can be said of each case."""
    worst = np.full(len(verdict["value"][0]), FINE)
    for part in reversed(PARTS):
        lost, off = verdict[part]
        levels = (VALUE_LOST, VALUE_OFF) if part == "value" else (2, 1)
        for level, here in zip(levels, (lost, off), strict=True):
            worst = np.maximum(worst, np.where(here, level, FINE))
    return worst


def verdicts(name):
    """Judgements of one model by ``(formula, precision)``."""
    chosen, wi, wo = cases(name)
    rows = differentiated(ours(name))
    double, moved = spread(rows, chosen, wi, wo)
    known = np.load(TRUTH)
    exact = known[name] if name in known else double
    found = {("ours", "float32"): rows(chosen, wi, wo, "float32")}
    if name in known:
        found["ours", "float64"] = double
    if name in textbook.MODELS:
        typed = differentiated(printed(name))
        for precision in ROUNDING:
            found["printed", precision] = typed(chosen, wi, wo, precision)
    return {key: judge(x, exact, moved, key[1]) for key, x in found.items()}


def line(name, key, verdict):
    """Counts of one formula in one precision."""
    worst = severity(verdict)
    counts = {"model": name, "formula": key[0], "precision": key[1]}
    counts |= {"cases": len(worst), "bad": int((worst > FINE).sum())}
    for part, (lost, off) in verdict.items():
        counts |= {f"{part}_not_finite": int(lost.sum())}
        counts |= {f"{part}_off": int(off.sum())}
    return counts


@styled
def map_of(name, judged):
    """Cases of one model: parameters down, directions across."""
    rows, columns = list(settings(name)), list(directions())
    precisions = [p for p in ROUNDING if any(key[1] == p for key in judged)]
    formulas = [f for f in FORMULAS if any(key[0] == f for key in judged)]
    tall = 0.15 * len(rows) + 0.3
    figure = new_figure(2.4 + 3.4 * len(formulas), 2.2 + tall * len(precisions))
    grid = figure.subplots(len(precisions), len(formulas), squeeze=False)
    for (y, precision), (x, formula) in (
        (a, b) for a in enumerate(precisions) for b in enumerate(formulas)
    ):
        axes = grid[y, x]
        worst = severity(judged[formula, precision])
        axes.imshow(
            worst.reshape(len(rows), len(columns)),
            cmap=ListedColormap(COLOURS),
            norm=BoundaryNorm(np.arange(6) - 0.5, 5),
            aspect="auto",
            interpolation="nearest",
        )
        bad, of = int((worst > FINE).sum()), len(worst)
        axes.set_title(f"{formula}, {precision}: {bad} of {of} wrong")
        axes.set_xticks(np.arange(-0.5, len(columns)), minor=True)
        axes.set_yticks(np.arange(-0.5, len(rows)), minor=True)
        axes.grid(visible=False)
        axes.grid(which="minor", color="white", linewidth=0.7)
        axes.tick_params(which="both", length=0)
        last, first = y == len(precisions) - 1, x == 0
        axes.set_xticks(
            range(len(columns)), columns if last else [], rotation=90, size=6
        )
        axes.set_yticks(range(len(rows)), rows if first else [], size=6)
        if last:
            axes.set_xlabel("directions to light and viewer (rad: above the horizon)")
    handles = [
        Patch(facecolor=c, label=m) for c, m in zip(COLOURS, MEANING, strict=True)
    ]
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(formulas) + 1, fontsize=8
    )
    figure.suptitle(headline(name, judged))
    return figure


def headline(name, judged):
    """The finding of one model as a sentence."""

    def failures(key):
        worst = severity(judged[key])
        return int((worst > FINE).sum()), len(worst)

    bad, of = failures(("ours", "float32"))
    if ("printed", "float32") not in judged:
        return f"{name} in float32: {bad} of {of} cases wrong"
    before, _ = failures(("printed", "float32"))
    return f"{name} in float32: printed {before} of {of} cases wrong, ours {bad}"


def by_direction(all_judged):
    """Cases of all models at each pair of directions, and how many are wrong."""
    rows = {}
    for judged in all_judged.values():
        for formula in FORMULAS:
            if (formula, "float32") not in judged:
                continue
            worst = severity(judged[formula, "float32"])
            for place, pair in enumerate(directions()):
                here = worst[place :: len(directions())]
                row = rows.setdefault(pair, {"wi, wo": pair})
                for what, count in (
                    ("cases", len(here)),
                    ("value_wrong", int((here >= VALUE_OFF).sum())),
                    ("only_derivative_wrong", int(((here > FINE) & (here < 3)).sum())),
                ):
                    key = f"{formula}_{what}"
                    row[key] = row.get(key, 0) + count
    return list(rows.values())


def finding(all_judged):
    """What all models together show in float32, as a sentence."""
    said = []
    for formula in FORMULAS:
        key = formula, "float32"
        every = [severity(v[key]) for v in all_judged.values() if key in v]
        worst = np.concatenate(every) if every else np.zeros(1)
        bad, of = int((worst > FINE).sum()), len(worst)
        said.append(f"{formula} {bad:,} of {of:,} cases wrong ({100 * bad / of:.2g} %)")
    return ", ".join(said)


@styled
def overview(all_judged):
    """Share of cases that go wrong in float32, for every model."""
    names = list(all_judged)[::-1]
    figure = new_figure(8.2, 1.6 + 0.25 * len(names))
    both = figure.subplots(1, 2, sharey=True, sharex=True)
    for axes, formula in zip(both, FORMULAS, strict=True):
        for y, name in enumerate(names):
            if (formula, "float32") not in all_judged[name]:
                axes.text(1, y, "no closed formula", size=7, va="center")
                continue
            worst = severity(all_judged[name][formula, "float32"])
            start = 0.0
            for level in range(VALUE_LOST, FINE, -1):
                share = 100 * np.mean(worst == level)
                axes.barh(y, share, left=start, color=COLOURS[level], height=0.75)
                start += share
            text = f"{(worst > FINE).sum()} of {len(worst)}"
            axes.text(start + 1, y, text, size=7, va="center")
        axes.set_title(TITLES[formula])
        axes.set_xlabel("share of hard cases that are wrong (%)")
        axes.grid(visible=False, axis="y")
    both[0].set_yticks(range(len(names)), names)
    both[0].set_ylim(-0.6, len(names) - 0.4)
    both[0].set_xlim(0, 100)
    handles = [
        Patch(facecolor=c, label=m) for c, m in zip(COLOURS, MEANING, strict=True)
    ]
    figure.legend(handles=handles[1:], loc="outside lower center", ncols=4, fontsize=8)
    figure.suptitle(f"float32: {finding(all_judged)}", size=10)
    return figure


def main(folder=RESULTS / "stability", names=None):
    """Judge every model, and draw the maps."""
    record = Record(folder)
    names = names or sorted(set(MODELS) - set(SKIPPED))
    judged = {}
    for name in names:
        judged[name] = verdicts(name)
        record.figure(map_of(name, judged[name]), name)
        print(headline(name, judged[name]), flush=True)
    record.figure(overview(judged))
    record.table([line(n, key, v) for n in names for key, v in judged[n].items()])
    record.table(by_direction(judged), "directions")
    record.close(
        finding=f"float32: {finding(judged)}.",
        relative=RELATIVE,
        ratio=RATIO,
        background=BACKGROUND,
    )


if __name__ == "__main__":
    names = [word for word in sys.argv[1:] if word != "--full"]
    if "--full" in sys.argv:
        main(RESULTS / "stability" / "full", names)
    else:
        main(names=names or SOME)
