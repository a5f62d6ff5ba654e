"""Many models on one measurement, under one residual, ranked."""

import dataclasses
import json
import os
from collections.abc import Callable, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from brdffit.files import replacing
from brdffit.fit.appearance import ColourDifference, sphere_difference
from brdffit.fit.blocks import usable
from brdffit.fit.fit import default_residual, fit
from brdffit.fit.misfit import misfit
from brdffit.fit.residual import Residual
from brdffit.fit.result import FitResult
from brdffit.models import MODELS, AbstractBRDF
from brdffit.parameters import registry_name
from brdffit.samples import Measurement, Samples, as_samples

HELD_OUT = 0.2  # share of the directions that a fit never sees
LOBE = "ggx_lobe"  # what is added as a second lobe
TIE = 2.0  # standard errors of the difference within which two models tie


@dataclasses.dataclass(frozen=True)
class Entry:
    """One model of a comparison.

    Attributes:
        result: The fit to all directions.
        held_out: Root mean square of the residual on directions that a second fit,
            to the others, never saw; they weigh as their solid angle.
        tied: True when it differs from the winner on those directions by no more than
            noise: neither in squared error nor in magnitude by two standard errors.
        look: Computes `colour`.
    """

    result: FitResult
    held_out: float
    tied: bool
    look: Callable[[], ColourDifference | None] | None = dataclasses.field(
        default=None, repr=False, compare=False
    )

    @cached_property
    def colour(self) -> ColourDifference | None:
        """How differently a sphere looks from the photographed one.

        Where the data show none, from that of the winner; None where the channels are
        no colours. Computed when first asked for, because that is slow to begin.
        """
        return self.look() if self.look else None


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Models ranked by their error on held-out directions, the best first.

    Attributes:
        entries: One per model.
        residual: Name of the residual that was minimised and is ranked by.
        held_out_count: Number of directions held out.
        seed: Seed of the split.
        data: Name of the measurement.
        second_lobe: Whether a second lobe earned its parameters, as a sentence; empty
            when none was asked for.
    """

    entries: tuple[Entry, ...]
    residual: str
    held_out_count: int
    seed: int
    data: str
    second_lobe: str = ""

    @property
    def best(self) -> FitResult:
        """The fit of the winner."""
        return self.entries[0].result

    @property
    def results(self) -> dict[str, FitResult]:
        """The fit of each model, by its name, in the order of the ranking.

        Where two models share a name the later one is called ``name (2)``.
        """
        found: dict[str, FitResult] = {}
        for entry in self.entries:
            name = entry.result.model
            count = sum(known.partition(" (")[0] == name for known in found)
            found[f"{name} ({count + 1})" if count else name] = entry.result
        return found

    def to_dict(self) -> dict[str, Any]:
        """The comparison in types that JSON knows."""
        return {
            "data": self.data,
            "residual": self.residual,
            "held_out_count": self.held_out_count,
            "seed": self.seed,
            "second_lobe": self.second_lobe,
            "ranking": [
                {"held_out": entry.held_out, "tied": entry.tied}
                | {"colour": entry.colour and dataclasses.asdict(entry.colour)}
                | entry.result.to_dict()
                for entry in self.entries
            ],
        }

    def save(self, path: str | os.PathLike) -> None:
        """Write the comparison as JSON."""
        with replacing(Path(path)) as temporary:
            temporary.write_text(json.dumps(self.to_dict(), indent=2) + "\n")


def compare(
    data: Measurement | Samples,
    models: Sequence[str | AbstractBRDF] | None = None,
    *,
    residual: str | Residual | None = None,
    starts: int = 16,
    seed: int = 0,
    second_lobe: bool = False,
    on_model: Callable[[str], None] | None = None,
) -> Comparison:
    """Fit many models to one measurement and rank them.

    Each model is fitted twice under the same residual: to all directions, which gives
    its parameters and criteria, and to four fifths of them, which gives its error on
    the rest. The split is the same for all models.

    Args:
        data: What to explain.
        models: Names or models; all of the catalogue by default.
        residual: As for `fit`.
        starts: As for `fit`.
        seed: Seed of the split into seen and held-out directions.
        second_lobe: Also try the winner with `ggx_lobe` added, and rank it if the lobe
            earns its parameters: lower BIC and, beyond noise, lower held-out error.
        on_model: Called with the name of each model before it is fitted.

    Returns:
        The ranking. Models within the noise of the winner are marked as tied with it.

    Raises:
        ValueError: As for `fit`, or fewer than five usable directions.
    """
    samples = as_samples(data)
    chosen = default_residual(data, residual)
    rows = np.flatnonzero(usable(samples, chosen).any(axis=1))
    if len(rows) < 5:
        raise ValueError(
            f"Data `{samples.name}` must have at least 5 usable directions to hold "
            f"some out, but has {len(rows)}."
        )
    seen, unseen = split(rows, seed)
    share = _share(samples.take(unseen))

    options = {"residual": chosen, "starts": starts}

    def tried(model: str | AbstractBRDF) -> tuple[FitResult, np.ndarray]:
        if on_model:
            on_model(model if isinstance(model, str) else registry_name(model))
        result = fit(model, samples, **options)
        blind = fit(model, samples.take(seen), **options)
        errors = misfit(blind.brdf, samples.take(unseen), chosen)
        # the square of each direction, over its channels
        return result, np.nanmean(errors**2, axis=1) * share

    fitted = [tried(model) for model in models or list(MODELS)]
    fitted.sort(key=_rms)
    told = ""
    if second_lobe:
        winner = fitted[0]
        richer = tried(f"{winner[0].model}+{LOBE}")
        earned = richer[0].bic < winner[0].bic and not _tied(winner[1], richer[1])
        if earned:
            fitted.insert(0, richer)
        earns = "earns" if earned else "does not earn"
        told = (
            f"A second lobe on {winner[0].model} {earns} its parameters: the held-out "
            f"error goes from {_rms(winner):.4g} to {_rms(richer):.4g}, and BIC by "
            f"{richer[0].bic - winner[0].bic:+.4g}."
        )
    best = fitted[0][1]
    return Comparison(
        entries=tuple(
            Entry(
                result,
                _rms((result, squares)),
                _tied(squares, best),
                partial(sphere_difference, result.brdf, data, fitted[0][0].brdf),
            )
            for result, squares in fitted
        ),
        residual=chosen.name,
        held_out_count=len(unseen),
        seed=seed,
        data=samples.name,
        second_lobe=told,
    )


def _share(samples: Samples) -> np.ndarray:
    """Weight of each direction by its solid angle, 1 on average."""
    if samples.solid_angle is None:
        return np.ones(len(samples))
    return np.asarray(samples.solid_angle) / np.mean(samples.solid_angle)


def _rms(tried: tuple[FitResult, np.ndarray]) -> float:
    """Root mean square over the held-out directions, by which models are ranked."""
    return float(np.sqrt(np.mean(tried[1])))


def split(rows: np.ndarray, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows that a fit may see, and the share of `HELD_OUT` that it may not."""
    shuffled = np.random.default_rng(seed).permutation(rows)
    unseen, seen = np.split(shuffled, [max(1, round(HELD_OUT * len(rows)))])
    return np.sort(seen), np.sort(unseen)


def _tied(squares: np.ndarray, best: np.ndarray) -> bool:
    """True when a model differs from the winner by no more than noise.

    Errors are compared direction by direction, as squares, by which models are ranked,
    and as magnitudes, on which a single wild direction has less of a say.
    """
    if squares is best or len(squares) < 2:
        return squares is best
    differences = squares - best, np.sqrt(squares) - np.sqrt(best)
    return all(
        np.mean(d) <= TIE * np.std(d, ddof=1) / np.sqrt(len(d)) for d in differences
    )
