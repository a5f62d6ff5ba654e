"""What do the approximations inside BRDF models cost in accuracy, and save in time?

Every approximation beside its exact form in the same model, in single precision, on
random pairs of directions up to 85 degrees from the normal. The error is the root mean
square of the difference of f_r cos_i from that of the exact form in double precision,
relative to it. What has no exact form is compared with the most complete one: roughness
with the model of Oren and Nayar with interreflection, and light that facets reflect
again with the lobe of Kulla and Conty. Lambert's law and EON, whose parameters mean
something else than those of Oren and Nayar, are fitted to it first.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from benchmarks.measure import use_one_core
from brdffit import Measurement, fit, optics
from brdffit.geometry import bisector
from brdffit.microfacet import fresnel, masking_shadowing, ndf
from brdffit.models import (
    GGX,
    ConductorBeckmann,
    ConductorGGX,
    DielectricGGX,
    Eon,
    GGXLobe,
    GGXMultiscatter,
    He,
    Lambert,
    OrenNayar,
    OrenNayarFull,
)
from experiments.pareto import chart
from experiments.record import RESULTS, Record
from experiments.tradeoff import Variant, measured, root_mean_square, saved

PAIRS = 2**15
STEEPEST = 85.0  # degrees
SEED = 3
TURNS = 15
ORDERS = (1, 3, 10, 30)
ROUGH = {"albedo": [0.8, 0.5, 0.2], "sigma": 0.4}


class RationalBeckmann(ConductorBeckmann):
    """The metal with the rational approximation of Smith's masking."""

    def evaluate(self, wi, wo):
        """As the model does, but for masking."""
        wh, alpha = bisector(wi, wo), self.alpha
        areas = (
            masking_shadowing.area_beckmann_rational(w, alpha, alpha) for w in (wi, wo)
        )
        g = masking_shadowing.smith(wi[2], wo[2], *areas, self.separable)
        f = fresnel.conductor(fresnel.cos_d(wh), self.eta, self.k)
        return self.specular * f * (ndf.beckmann(wh, alpha, alpha) * g)


class HeOfOrders(He):
    """He's model with the first few orders of scattering only."""

    orders: int = eqx.field(static=True, default=1)

    def lobe(self, g, t):
        """The series as it is printed, cut off."""
        m = jnp.arange(1, self.orders + 1, dtype=g.dtype)
        powers = m * jnp.log(g) - g - jax.scipy.special.gammaln(m + 1)
        return (1 + g) * jnp.sum(jnp.exp(powers - (1 + g) * t / m) / m)


def questions():
    """Models by question and name; the exact form comes first."""
    metal = optics.conductor("Au", 0.2)
    gold = {"eta": metal.eta, "k": metal.k}
    glass_f0, gold_f0 = (
        0.04,
        ((metal.eta - 1) ** 2 + metal.k**2) / ((metal.eta + 1) ** 2 + metal.k**2),
    )
    rough = {"alpha": 0.5}
    wave = {"sigma0": 0.15, "tau": 1.5, "diffuse": jnp.zeros(3)} | gold
    wave |= {"wavelengths": jnp.array([0.61, 0.55, 0.465])}
    orders = {f"{n} order{'s' * (n > 1)}": HeOfOrders(orders=n, **wave) for n in ORDERS}
    return {
        "Fresnel of glass": {
            "exact": DielectricGGX(eta=1.5, alpha=0.2),
            "Schlick": GGXLobe(f0=glass_f0, alpha=0.2),
        },
        "Fresnel of gold": {
            "exact": ConductorGGX(alpha=0.2, **gold),
            "Schlick": GGXLobe(f0=gold_f0, alpha=0.2),
        },
        "Beckmann masking": {
            "exact": ConductorBeckmann(**rough, **gold),
            "rational": RationalBeckmann(**rough, **gold),
        },
        "heights of GGX facets": {
            "correlated": ConductorGGX(**rough, **gold),
            "separable": ConductorGGX(separable=True, **rough, **gold),
        },
        "scattering by facets": {
            "multiple": GGXMultiscatter(f0=gold_f0, **rough),
            "single": GGX(diffuse=jnp.zeros(3), f0=gold_f0, **rough),
        },
        "rough diffuse": {
            "full": OrenNayarFull(**ROUGH),
            "A/B": OrenNayar(**ROUGH),
            "EON, fitted": Eon(albedo=ROUGH["albedo"]),
            "Lambert, fitted": Lambert(albedo=ROUGH["albedo"]),
        },
        "orders of He": {"all orders": He(**wave)} | orders,
    }


def directions(count):
    """Random pairs of directions, spread evenly over the part of the sphere."""
    random = np.random.default_rng(SEED)
    z = random.uniform(np.cos(np.radians(STEEPEST)), 1, (2, count))
    phi, s = random.uniform(0, 2 * np.pi, (2, count)), np.sqrt(1 - z**2)
    return np.stack([s * np.cos(phi), s * np.sin(phi), z], axis=-1).astype(np.float32)


@jax.jit
def reflected(brdf, wi, wo):
    """``f_r cos_i`` of every pair."""
    return jax.vmap(brdf)(wi, wo) * wi[:, 2:]


def exact(brdf, wi, wo):
    """The same in double precision."""
    with jax.enable_x64(True):
        double = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), brdf)
        pairs = (jnp.asarray(w, jnp.float64) for w in (wi, wo))
        return np.asarray(reflected(double, *pairs))


def fitted(brdf, wi, wo, wanted):
    """A model of other parameters as close to what is wanted as it comes."""
    data = Measurement(wi=wi, wo=wo, f_r=wanted / wi[:, 2:])
    return fit(brdf, data, residual="cosine_weighted", starts=4).brdf


def rows_of(question, models, count, turns):
    """Lines of one question."""
    wi, wo = directions(count)
    wanted = exact(next(iter(models.values())), wi, wo)
    wi, wo = jnp.asarray(wi), jnp.asarray(wo)
    variants = []
    for name, brdf in models.items():
        if name.endswith("fitted"):
            brdf = fitted(brdf, np.asarray(wi), np.asarray(wo), wanted)
        brdf = jax.tree.map(lambda x: jnp.asarray(x, jnp.float32), brdf)

        def run(brdf=brdf):
            return jax.block_until_ready(reflected(brdf, wi, wo))

        variants.append(Variant(name, run, root_mean_square(wanted)))
    return measured(question, variants, turns, share=1 / count)


def title(rows):
    """What one question found: the best approximation against the exact form."""
    reference, *others = rows
    best = min(others, key=lambda row: row["error"])
    return (
        f"{reference['question']}: {best['variant']}\n{saved(best, reference)}, "
        f"costs {100 * best['error']:.2g} % in error"
    )


def finding(rows):
    """What all together found, as a sentence."""
    by = {(row["question"], row["variant"]): row for row in rows}
    said = []
    for question, variant in (
        ("Beckmann masking", "rational"),
        ("Fresnel of gold", "Schlick"),
    ):
        if (question, variant) in by:
            row = by[question, variant]
            reference = next(r for r in rows if r["question"] == question)
            said.append(
                f"{question}, {variant}: {saved(row, reference)} and costs "
                f"{100 * row['error']:.2g} % in error"
            )
    return "; ".join(said)


def main(folder=RESULTS / "forward_models", count=PAIRS, turns=TURNS, chosen=None):
    """Write table and figure."""
    record, rows = Record(folder, SEED), []
    for question, models in questions().items():
        if chosen is None or question in chosen:
            rows += rows_of(question, models, count, turns)
    record.table(rows)
    found = {}
    for row in rows:
        found.setdefault(row["question"], []).append(row)
    figure = chart(
        rows,
        {question: title(own) for question, own in found.items()},
        finding(rows),
        unit="ns",
        error="relative RMS error",
        time_of="one evaluation",
    )
    record.figure(figure)
    record.close(finding=finding(rows) + ".", pairs=count, turns=turns)


if __name__ == "__main__":
    use_one_core()
    main()
