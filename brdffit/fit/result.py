"""What a fit returns: the material, how sure it is, and how it was reached."""

import dataclasses
import json
import math
import os
from functools import cached_property
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from brdffit.albedo import directional_albedo
from brdffit.catalogue import description, from_description
from brdffit.files import replacing
from brdffit.models import AbstractBRDF

PAIRS = 1000  # of directions, on which reciprocity is checked


@dataclasses.dataclass(frozen=True)
class FitResult:
    """A fitted model.

    Attributes:
        brdf: The fitted model.
        model: Its name.
        parameters: Values by name: a float, or an array with one value per channel.
        standard_errors: One standard deviation of each, in the same shape; infinite
            where undetermined. For a parameter at its bound the error it would have if
            it were free.
        held: Labels of the parameters that were held.
        labels: Name of each row of `correlation`, in the order of `parameters`.
        correlation: Correlation of the errors; 0 for parameters at a bound or
            undetermined.
        at_bound: Sentence per parameter that sits on a bound of its legal interval.
        undetermined: Sentence per parameter that the data cannot tell.
        residual: Name of the residual that was minimised.
        loss: Name of the robust loss of it, or None for its square.
        cost: Half the weighted sum of squares of that residual, solid angles and known
            errors included, priors not.
        costs: The same under every residual, at this solution.
        rms: Root of the mean square under every residual; values weigh as their solid
            angle, when the data tell it, and not by their errors.
        explained: Share of the weighted variance of the data that the model explains;
            None where the data do not vary.
        count: Number of values used (samples times channels).
        masked: Number of values left out.
        chi_square: Sum of squares over known variances, or None when unknown.
        p_value: Probability of a larger one if the model is right, or None.
        aicc: Akaike's criterion, corrected for small samples.
        bic: Schwarz's criterion.
        converged: True when the solver met its tolerance.
        status: The outcome as a sentence.
        steps: Solver steps of the winning start.
        starts: Number of starts.
        basins: Number of distinct minima that the starts ended in.
        agreement: Share of starts that ended in the best one.
        path: How the fit was solved: which structure was found and used.
        seconds: Time taken, compilation included.
        data: Name of the measurement.
        channels: Names of the channels.
    """

    brdf: AbstractBRDF
    model: str
    parameters: dict[str, Any]
    standard_errors: dict[str, Any]
    held: tuple[str, ...]
    labels: tuple[str, ...]
    correlation: np.ndarray
    at_bound: dict[str, str]
    undetermined: dict[str, str]
    residual: str
    loss: str | None
    cost: float
    costs: dict[str, float]
    rms: dict[str, float]
    explained: float | None
    count: int
    masked: int
    chi_square: float | None
    p_value: float | None
    aicc: float
    bic: float
    converged: bool
    status: str
    steps: int
    starts: int
    basins: int
    agreement: float
    path: str
    seconds: float
    data: str
    channels: tuple[str, ...]

    @cached_property
    def albedo(self) -> np.ndarray:
        """Directional albedo of the fitted BRDF for light along the normal.

        One value per channel, computed when first asked for.
        """
        normal = jnp.array([0.0, 0.0, 1.0])
        return np.asarray(directional_albedo(self.brdf, normal))

    @cached_property
    def reciprocity(self) -> float:
        """Largest relative change of the fitted BRDF when light and viewer swap.

        Over `PAIRS` pairs of directions spread over the hemisphere; 0 for a reciprocal
        model up to rounding. Computed when first asked for.
        """
        z, turn = np.random.default_rng(0).uniform(0.05, 1, (2, 2, PAIRS))
        radius, phi = np.sqrt(1 - z * z), 2 * np.pi * turn
        w = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
        wi, wo = jnp.asarray(w, jnp.float32)
        f_r = jax.jit(jax.vmap(self.brdf))
        there, back = np.asarray(f_r(wi, wo)), np.asarray(f_r(wo, wi))
        larger = np.maximum(np.maximum(there, back), np.finfo(np.float32).tiny)
        return float(np.max(np.abs(there - back) / larger))

    def to_dict(self) -> dict[str, Any]:
        """Everything but the model object, in types that JSON knows."""
        fields = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        del fields["brdf"]
        return {name: plain(value) for name, value in fields.items()}

    def save(self, path: str | os.PathLike) -> None:
        """Write the result as JSON, which `load_result` reads back."""
        content = self.to_dict() | {"brdf": description(self.brdf)}
        text = json.dumps(content, indent=2, allow_nan=False)
        with replacing(Path(path)) as temporary:
            temporary.write_text(text + "\n")


def load_result(path: str | os.PathLike) -> FitResult:
    """Read a result written by `FitResult.save`.

    Raises:
        OSError: The file cannot be read.
        ValueError: It is not a result of this package.
    """
    path = Path(path)
    try:
        fields = json.loads(path.read_text())
        brdf = from_description(fields.pop("brdf"))
        for name in ("parameters", "standard_errors"):
            fields[name] = {n: _array(v) for n, v in fields[name].items()}
        fields["correlation"] = np.array(fields["correlation"])
        for name in ("held", "labels", "channels"):
            fields[name] = tuple(fields[name])
        for name in ("costs", "rms"):
            fields[name] = {n: float(v) for n, v in fields[name].items()}
        for name in ("aicc", "bic"):
            fields[name] = float(fields[name])
        return FitResult(brdf=brdf, **fields)
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(
            f"File `{path}` must be a result saved by brdffit, but it cannot be read "
            f"as one ({type(error).__name__}: {error})."
        ) from error


def plain(value: Any) -> Any:
    """The same value in types that JSON knows; what is not finite as a word."""
    if isinstance(value, dict):
        return {name: plain(v) for name, v in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)  # JSON has no infinity
    return value


def _array(value: Any) -> Any:
    if isinstance(value, list):
        return np.array([float(v) for v in value])
    return float(value)
