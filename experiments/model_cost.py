"""Which model leaves how much error on measured materials, and how fast is it?

Two black coatings (UA-LOFT), sintered PTFE (NIST), paper and a golden yellow (RGL),
photographs of a ball (DiLiGenT) and three stand-ins for materials of MERL (see
`merl_standins`), the green channel of each, fitted by every model, photographs under
the cosine-weighted residual, all else under the log one. The error is what the fit
leaves: the root mean square of the logarithm, of photographs relative to that of the
values. The time is that of one evaluation of the model in single precision, on one
core, the same for all materials.

Materials whose data are not in the folder that `BRDFFIT_DATA` names are left out.
"""

import sys

import jax
import jax.numpy as jnp
import numpy as np

import brdffit
from benchmarks.measure import use_one_core
from brdffit.catalogue import from_name
from brdffit.samples import Measurement
from experiments.forward_models import directions, reflected
from experiments.measured_sets import COUNT, grey, present
from experiments.pareto import chart
from experiments.record import RESULTS, Record
from experiments.tradeoff import Variant, front, measured

MODELS = (
    *("lambert", "oren_nayar", "phong", "ward_duer", "cook_torrance", "ggx"),
    *("student_t", "ashikhmin_shirley", "plastic_ggx", "principled", "ggx+ggx_lobe"),
)
PAIRS, TURNS, STARTS = 2**15, 11, 8
PANEL = 4.3, 3.5  # inches


def times(models, count, turns):
    """Line with the time of one evaluation of each model."""
    wi, wo = (jnp.asarray(w) for w in directions(count))
    variants = []
    for name in models:
        brdf = from_name(name, 1)
        brdf = jax.tree.map(lambda x: jnp.asarray(x, jnp.float32), brdf)

        def run(brdf=brdf):
            return jax.block_until_ready(reflected(brdf, wi, wo))

        variants.append(Variant(name, run, lambda _: 0.0))
    rows = measured("evaluation", variants, turns, share=1 / count)
    return {row["variant"]: row for row in rows}


def error_of(fit, data):
    """What a fit leaves, relative to the values."""
    if isinstance(data, Measurement):
        return fit.rms["log"]
    value = np.asarray(data.value)[np.asarray(data.mask)]
    return fit.rms["cosine_weighted"] / float(np.sqrt(np.mean(value**2)))


def rows_of(name, models, evaluation, count, starts):
    """Lines of one material."""
    data, rows = grey(name, count), []
    for model in models:
        fit = brdffit.fit(model, data, starts=starts)
        rows.append(
            evaluation[model]
            | {"question": name, "error": error_of(fit, data)}
            | {"fit_seconds": fit.seconds, "converged": fit.converged}
        )
    best = front(rows)
    return [row | {"on_front": row in best} for row in rows]


def title(rows):
    """The best model of a material, and the cheapest one that is nearly as good."""
    best = min(rows, key=lambda row: row["error"])
    plain = next(row for row in rows if row["variant"] == "lambert")
    return (
        f"{rows[0]['question']}: {best['variant']}\nleaves {best['error']:.2g} where "
        f"lambert leaves {plain['error']:.2g}"
    )


def finding(found):
    """Which model is on the front most often, as a sentence."""
    on = [row["variant"] for rows in found.values() for row in rows if row["on_front"]]
    best = [min(rows, key=lambda r: r["error"])["variant"] for rows in found.values()]
    often = max(sorted(set(on) - {"lambert"}), key=on.count, default="lambert")
    winner = max(sorted(set(best)), key=best.count)
    return (
        f"On {len(found)} measured materials {winner} leaves the least error on "
        f"{best.count(winner)}; beside lambert, {often} is most often on the front of "
        f"error and time, on {on.count(often)}"
    )


def main(
    folder=RESULTS / "model_cost",
    models=MODELS,
    names=None,
    count=COUNT,
    pairs=PAIRS,
    turns=TURNS,
    starts=STARTS,
):
    """Write table and figure."""
    names = names or present()
    if not names:
        sys.exit("No measured material is here: set BRDFFIT_DATA.")
    record = Record(folder, seed=0)
    evaluation = times(models, pairs, turns)
    found = {}
    for name in names:
        found[name] = rows_of(name, models, evaluation, count, starts)
        print(name, title(found[name]), flush=True)
    rows = [row for own in found.values() for row in own]
    record.table(rows)
    figure = chart(
        rows,
        {name: title(own) for name, own in found.items()},
        finding(found),
        unit="ns",
        error="relative error left (RMS)",
        time_of="one evaluation",
        panel=PANEL,
    )
    record.figure(figure)
    record.close(finding=finding(found) + ".", samples=count, starts=starts)


if __name__ == "__main__":
    use_one_core()
    main()
