"""How sure a fit is: standard errors, correlation, and what the data cannot tell.

Everything comes from the weighted Jacobian at the solution. Parameters on a bound or
held fixed take no part in the errors of the others.
"""

import dataclasses

import numpy as np

NULL = 1e-10  # eigenvalue of the scaled Hessian below which a direction is not seen
INVOLVED = 0.05  # share of a null direction that makes a parameter part of it


@dataclasses.dataclass(frozen=True)
class Uncertainty:
    """Errors of all parameters, in the order of the layout, in natural units.

    Attributes:
        standard_errors: One standard deviation; infinite where undetermined.
        correlation: Matrix of correlations; 0 where one of the two is undetermined.
        undetermined: Sentence per parameter that the data cannot tell, by label.
    """

    standard_errors: np.ndarray
    correlation: np.ndarray
    undetermined: dict[str, str]


def uncertainty(
    hessian: np.ndarray,
    natural: np.ndarray,
    slopes: np.ndarray,
    spans: np.ndarray,
    held: np.ndarray,
    variance: float,
    labels: tuple[str, ...],
) -> Uncertainty:
    """Errors from the Gauss-Newton Hessian at the solution.

    Args:
        hessian: ``J^T J`` in solver coordinates.
        natural: Parameter values.
        slopes: Derivative of each value along its solver coordinate.
        spans: Width of each legal interval, in natural units.
        held: True for parameters on a bound or fixed.
        variance: Variance of a residual of unit weight.
        labels: Names of the parameters.
    """
    count = len(natural)
    jacobian_scale = np.sqrt(np.diag(hessian))
    seen = jacobian_scale > 0
    free = ~held & seen
    scale = np.where(seen, jacobian_scale, 1)
    scaled = hessian / np.outer(scale, scale)

    undetermined = {
        labels[i]: f"`{labels[i]}` has no effect on these data."
        for i in np.flatnonzero(~seen & ~held)
    }
    covariance, null = _invert(scaled[np.ix_(free, free)], variance)
    free_places = np.flatnonzero(free)
    per_scale = slopes / scale
    relative = per_scale[free] / np.where(
        natural[free] != 0, natural[free], spans[free]
    )

    # a direction is lost as well when its error is wider than the legal interval
    wide = np.sqrt(np.diag(covariance)) * np.abs(per_scale[free]) > spans[free]
    for direction in null:
        parts = np.abs(direction) > INVOLVED * np.abs(direction).max()
        sentence = _sentence(
            [labels[i] for i in free_places[parts]], (direction * relative)[parts]
        )
        for i in free_places[parts]:
            undetermined.setdefault(labels[i], sentence)
    for i in free_places[wide]:
        undetermined.setdefault(
            labels[i],
            f"`{labels[i]}` is not determined by these data: its standard error is "
            "wider than its legal range.",
        )

    full = np.zeros((count, count))
    full[np.ix_(free, free)] = covariance
    errors = np.sqrt(np.maximum(np.diag(full), 0)) * np.abs(per_scale)
    for i in np.flatnonzero(held & seen):
        alone, _ = _invert(
            scaled[
                np.ix_(free | (np.arange(count) == i), free | (np.arange(count) == i))
            ],
            variance,
        )
        position = np.count_nonzero((free | (np.arange(count) == i))[:i])
        errors[i] = np.sqrt(max(alone[position, position], 0)) * abs(per_scale[i])
    lost = np.array([label in undetermined for label in labels])
    errors[lost] = np.inf

    deviation = np.sqrt(np.maximum(np.diag(full), 0))
    sure = (deviation > 0) & ~lost
    correlation = np.eye(count)
    block = full[np.ix_(sure, sure)] / np.outer(deviation[sure], deviation[sure])
    correlation[np.ix_(sure, sure)] = np.clip(block, -1, 1)
    return Uncertainty(errors, correlation, undetermined)


def _invert(scaled: np.ndarray, variance: float) -> tuple[np.ndarray, np.ndarray]:
    """Covariance over the directions that the data see, and the null directions."""
    if scaled.size == 0:
        return scaled, np.zeros((0, 0))
    eigenvalues, vectors = np.linalg.eigh(scaled)
    lost = eigenvalues < NULL
    inverse = np.where(lost, 0, variance / np.where(lost, 1, eigenvalues))
    return (vectors * inverse) @ vectors.T, vectors[:, lost].T


def _sentence(labels: list[str], relative: np.ndarray) -> str:
    """A null direction in words: what undoes a change of the first parameter."""
    if len(labels) == 1:
        return f"`{labels[0]}` is not determined by these data."
    pivot = int(np.argmax(np.abs(relative)))
    change = 10.0
    ratios = relative / relative[pivot] * change
    names = ", ".join(f"`{label}`" for label in labels[:-1]) + f" and `{labels[-1]}`"
    others = ", ".join(
        f"{'raising' if ratio > 0 else 'lowering'} `{label}` by {abs(ratio):.3g} %"
        for i, (label, ratio) in enumerate(zip(labels, ratios, strict=True))
        if i != pivot
    )
    return (
        f"{names} cannot be told apart by these data: raising `{labels[pivot]}` by "
        f"{change:.0f} % is undone by {others}."
    )
