"""Does a fit find the truth again, for every model and from its own starts?

Truths are drawn from the typical ranges of all parameters and measured, without noise,
on a goniometer grid that has directions in and around even a narrow lobe. A truth is
recovered when the fit explains all but 1e-8 of the variation of the logarithm of the
data, and every parameter that the data determine is right to 1e-4. Of a product that
cannot be told apart only the product is determined, and the fit says so: its factors
have an infinite error, and whatever drifts with them a large one.

    python -m experiments.recovery [--full] [MODEL ...]

Without `--full` only some models and truths are tried.
"""

import sys
import time
import zlib

import jax
import jax.numpy as jnp
import numpy as np

import brdffit
from brdffit.fit.start import typical_box
from brdffit.fit.transforms import Layout, to_natural, unpack
from brdffit.models import MODELS
from brdffit.plots.style import COLOURS, DATA, entitle, new_figure
from brdffit.samples import Measurement
from brdffit.scene import Goniometer
from experiments.record import RESULTS, Record, styled

TRUTHS, FEW = 1000, 40
SOME = ("phong", "cook_torrance", "oren_nayar", "ggx")
SEED = 5
UNEXPLAINED = 1e-8
RIGHT = 1e-4
SPECULAR = (8.0, 35.0, 60.0, 76.0)  # degrees
AROUND = (-12.0, -5.0, -2.0, -0.7, 0.0, 0.7, 2.0, 5.0, 12.0)
GRID = Goniometer(
    theta_i=SPECULAR,
    theta_o=sorted(s + a for s in SPECULAR for a in AROUND if 0 <= s + a < 89),
    phi=(0, 40, 90, 130, 160, 172, 177, 179, 180),
)


def truths(name, count):
    """Models with parameters drawn from the typical ranges, the same every time."""
    brdf = MODELS[name]()
    layout = Layout.of(brdf)
    random = np.random.default_rng([SEED, zlib.crc32(name.encode())])
    places = tuple(range(len(layout.labels)))
    low, high = typical_box(layout)
    for share in random.uniform(size=(count, len(places))):
        x = jnp.asarray(low + share * (high - low))
        yield unpack(layout, brdf, to_natural(layout, x, places))


@jax.jit
def measured(brdf, wi, wo):
    """Reflectance in the precision of the parameters."""
    return jax.vmap(brdf)(wi, wo)


def recovered(brdf, result):
    """Whether a fit found the truth, and else what is wrong, in a word.

    Without noise a standard error tells only how far a direction that the data do not
    see lets a parameter drift; beyond four of them it is wrong all the same.
    """
    if result.explained is not None and 1 - result.explained > UNEXPLAINED:
        return "another minimum" if result.converged else "not converged"
    for name, truth in brdffit.parameters.values(brdf).items():
        away = np.abs(np.atleast_1d(result.parameters[name] - np.asarray(truth)))
        errors = np.atleast_1d(result.standard_errors[name])
        if np.any(away > np.maximum(RIGHT * np.abs(truth), 4 * errors)):
            return f"{name} off"
    return "recovered"


def row_of(name, count):
    """What became of the truths of one model, and the time of a fit."""
    wi, wo = GRID.directions()
    outcomes, seconds, undetermined, agreement = [], [], 0, []
    for number in range(count):
        if number == 0:
            with jax.enable_x64(True):
                made = truths(name, count)
        with jax.enable_x64(True):
            brdf = next(made)
            f_r = np.asarray(measured(brdf, jnp.asarray(wi), jnp.asarray(wo)))
        data = Measurement(wi=wi, wo=wo, f_r=f_r, name=f"{name} {number}")
        begin = time.perf_counter()
        result = brdffit.fit(name, data, residual="log")
        seconds.append(time.perf_counter() - begin)
        outcomes.append(recovered(brdf, result))
        undetermined += bool(result.undetermined)
        agreement.append(result.agreement)
    failures = [outcome for outcome in outcomes if outcome != "recovered"]
    kinds = sorted(set(failures), key=failures.count, reverse=True)
    return {
        "model": name,
        "truths": count,
        "recovered": 1 - len(failures) / count,
        "with_undetermined": undetermined / count,
        "starts_that_agree": float(np.median(agreement)),
        "milliseconds": 1000 * float(np.median(seconds)),
        "failures": "; ".join(f"{k} {failures.count(k)}" for k in kinds),
    }


@styled
def chart(rows, title):
    """Share of truths recovered, and what a fit takes."""
    figure = new_figure(8.0, 1.2 + 0.24 * len(rows))
    left, right = figure.subplots(1, 2, sharey=True)
    names = [row["model"] for row in rows]
    shares = [100 * row["recovered"] for row in rows]
    left.barh(names, shares, color=COLOURS[0], height=0.6)
    left.axvline(99, color=DATA, lw=0.8, ls=":", label="99 %")
    left.set(xlim=(0, 105), xlabel="truths recovered [%]")
    left.set_ylim(len(names) - 0.5, -0.5)
    right.plot([row["milliseconds"] for row in rows], names, "o", color=COLOURS[1])
    right.set(xscale="log", xlabel="time of one fit [ms], log scale")
    right.xaxis.set_major_formatter("{x:g}")
    right.xaxis.set_minor_formatter("{x:g}")
    figure.legend(loc="outside lower center")
    entitle(figure, title)
    return figure


def main(folder=RESULTS / "recovery", names=(), count=TRUTHS):
    """Write the table and the figure."""
    record = Record(folder, SEED)
    rows = []
    for name in names or MODELS:
        rows.append(row_of(name, count))
        print(rows[-1], flush=True)
    record.table(rows)
    share = sum(row["recovered"] for row in rows) / len(rows)
    finding = (
        f"{100 * share:.4g} % of {count * len(rows):,} truths of {len(rows)} models "
        "are recovered."
    )
    record.figure(chart(rows, finding))
    record.close(
        finding=finding,
        truths=count,
        samples=len(GRID.directions()[0]),
    )


if __name__ == "__main__":
    names = [word for word in sys.argv[1:] if word != "--full"]
    if "--full" in sys.argv:
        main(RESULTS / "recovery" / "full", names)
    else:
        main(names=names or SOME, count=FEW)
