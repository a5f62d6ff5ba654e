"""How sure a fit is: standard errors, correlation, and what the data cannot tell.

Everything comes from the weighted Jacobian at the solution, in solver coordinates.
"""

import dataclasses

import numpy as np

UNSEEN = 1e-10  # eigenvalue of the Hessian, at unit diagonal, that is mere rounding
# of directions that were stored in single precision
WIDE = 0.3  # a uniform guess has this standard error, in widths of the legal interval
INVOLVED = 0.05  # share of the largest part of a direction that counts as part of it


@dataclasses.dataclass(frozen=True)
class Uncertainty:
    """Errors of all parameters, in the order of the layout, in natural units.

    Attributes:
        standard_errors: One standard deviation; infinite where undetermined, 0 where
            fixed; on a bound the error that the parameter would have if it were free.
        correlation: Matrix of correlations; 0 where one of the two has no error.
        undetermined: Sentence per parameter that the data cannot tell, by label.
    """

    standard_errors: np.ndarray
    correlation: np.ndarray
    undetermined: dict[str, str]


def uncertainty(
    hessian: np.ndarray,
    natural: np.ndarray,
    slopes: np.ndarray,
    widths: np.ndarray,
    fixed: np.ndarray,
    at_bound: np.ndarray,
    variance: float,
    labels: tuple[str, ...],
    unseen: float = UNSEEN,
) -> Uncertainty:
    """Errors from the Gauss-Newton Hessian at the solution.

    Parameters on a bound take no part in the errors of the others, unless the data
    cannot tell them: then they only happened to stop there.

    Args:
        hessian: ``J^T J`` in solver coordinates.
        natural: Parameter values.
        slopes: Derivative of each value along its solver coordinate.
        widths: Width of each legal interval, in solver coordinates; may be infinite.
        fixed: True for parameters that were held.
        at_bound: True for parameters on a bound.
        variance: Variance of a residual of unit weight.
        labels: Names of the parameters.
        unseen: Eigenvalue of the Hessian, at unit diagonal, that is mere rounding.
    """
    seen = np.diag(hessian) > 0
    asked = ~fixed & seen
    unit = 1 / np.sqrt(np.where(seen, np.diag(hessian), 1))
    scaled = hessian * np.outer(unit, unit)

    undetermined = {
        labels[i]: f"`{labels[i]}` has no effect on these data."
        for i in np.flatnonzero(~seen & ~fixed)
    }
    relative = slopes / np.where(natural != 0, np.abs(natural), np.abs(slopes))
    places = np.flatnonzero(asked)
    spans = np.where(np.isfinite(widths), widths, unit)
    bounded = bool(np.all(np.isfinite(widths[places])))
    drift = np.zeros(len(labels))  # variance from directions the data do not see
    for direction in _lost(scaled, unit, spans, variance, places, unseen, bounded):
        if bounded:
            reach = WIDE / np.max(np.abs(direction))
            drift[places] += (reach * direction * spans[places]) ** 2
        change = direction * spans[places] * relative[places]
        parts = _large(direction) | _large(change)
        involved, change = places[parts], change[parts]
        shared = np.array(["[" not in labels[i] for i in involved])
        # a value that all channels share leads the sentence, when it takes its part
        leader = int(np.argmax(np.abs(change) * np.where(shared, 2, 1)))
        pivot = involved[leader]
        rest = np.setdiff1d(places[~at_bound[places]], [pivot])
        errors = np.sqrt(np.diag(_covariance(scaled, rest, variance, unseen)))
        precision = (errors * unit * np.abs(relative))[involved]
        sentence = _sentence([labels[i] for i in involved], change, precision, leader)
        for i in involved:
            undetermined.setdefault(labels[i], sentence)

    lost = np.array([label in undetermined for label in labels])
    free = asked & ~(at_bound & ~lost)
    covariance = _covariance(scaled, np.flatnonzero(free), variance, unseen)
    errors = np.sqrt(np.diag(covariance)) * unit * np.abs(slopes)
    for i in np.flatnonzero(asked & ~free):
        alone = np.flatnonzero(free | (np.arange(len(free)) == i))
        errors[i] = np.sqrt(_covariance(scaled, alone, variance, unseen)[i, i])
        errors[i] *= unit[i] * abs(slopes[i])
    # one that takes a small part in a lost direction is as sure as that lets it be
    errors = np.where(free, np.hypot(errors, np.sqrt(drift) * np.abs(slopes)), errors)
    errors[lost] = np.inf

    deviation = np.sqrt(np.diag(covariance))
    known = (deviation > 0) & ~lost
    correlation = np.eye(len(labels))
    block = covariance[np.ix_(known, known)]
    block = block / np.outer(deviation[known], deviation[known])
    correlation[np.ix_(known, known)] = np.clip(block, -1, 1)
    return Uncertainty(errors, correlation, undetermined)


def _lost(scaled, unit, widths, variance, places, least, bounded) -> np.ndarray:
    """Directions the data do not see, in widths of the legal intervals.

    Either the Hessian vanishes along them up to rounding, or the noise leaves them no
    better known than the interval already says.
    """
    if len(places) == 0:
        return np.zeros((0, 0))
    square = np.ix_(places, places)
    eigenvalues, vectors = np.linalg.eigh(scaled[square])
    unseen = (vectors.T * unit[places] / widths[places])[eigenvalues < least]
    if not bounded:
        return _sparse(unseen)
    # floor: rounding must not make a lost direction look sure
    solid = (vectors * np.maximum(eigenvalues, least)) @ vectors.T
    stretch = widths[places] / unit[places]
    spread, directions = np.linalg.eigh(solid * np.outer(stretch, stretch))
    vague = directions.T[variance / np.maximum(spread, 1e-300) > WIDE**2]
    return _sparse(unseen if len(unseen) >= len(vague) else vague)


def _large(parts: np.ndarray) -> np.ndarray:
    """Which parts of a direction matter beside its largest."""
    return np.abs(parts) > INVOLVED * np.abs(parts).max()


def _sparse(directions: np.ndarray) -> np.ndarray:
    """The same space spanned by directions that each involve few parameters."""
    rows = directions.copy()
    for i in range(len(rows)):
        row, column = np.unravel_index(np.argmax(np.abs(rows[i:])), rows[i:].shape)
        rows[[i, i + row]] = rows[[i + row, i]]
        rows[i] /= rows[i, column]
        others = np.arange(len(rows)) != i
        rows[others] -= np.outer(rows[others, column], rows[i])
    return rows


def _covariance(
    scaled: np.ndarray, free: np.ndarray, variance: float, unseen: float
) -> np.ndarray:
    """Covariance of the free parameters at unit diagonal, 0 for the others."""
    whole = np.zeros_like(scaled)
    eigenvalues, vectors = np.linalg.eigh(scaled[np.ix_(free, free)])
    lost = eigenvalues < unseen
    inverse = np.where(lost, 0, variance / np.where(lost, 1, eigenvalues))
    whole[np.ix_(free, free)] = (vectors * inverse) @ vectors.T
    return whole


def _sentence(
    labels: list[str], change: np.ndarray, precision: np.ndarray, pivot: int
) -> str:
    """A lost direction in words: what undoes a change of its leading parameter.

    Args:
        labels: Parameters involved.
        change: Relative change of each along the direction.
        precision: Relative error of each when the leading one is held.
        pivot: Index of the leading parameter.
    """
    if len(labels) == 1:
        return (
            f"`{labels[0]}` is not determined by these data: its error is as wide as "
            "its legal interval."
        )
    ratio = change / change[pivot] * 10
    groups: dict[str, list[int]] = {}
    for i, label in enumerate(labels):
        if i != pivot:
            groups.setdefault(label.partition("[")[0], []).append(i)
    names, undone, sure = [labels[pivot]], [], []
    for name, members in groups.items():
        low, high = np.min(ratio[members]), np.max(ratio[members])
        together = high - low < 0.01 * abs(high)
        if len(members) == 1:
            name = labels[members[0]]
        names.append(name)
        parts = [(name, high)] if together else [(labels[i], ratio[i]) for i in members]
        undone += [
            f"{'raising' if r > 0 else 'lowering'} `{n}` by {abs(r):.3g} %"
            for n, r in parts
        ]
        sure.append(f"`{name}` to {100 * np.max(precision[members]):.2g} %")
    return (
        f"{_listed([f'`{name}`' for name in names])} cannot be told apart by these "
        f"data: raising `{labels[pivot]}` by 10 % is undone by {_listed(undone)}. With "
        f"`{labels[pivot]}` held, the data determine {_listed(sure)}."
    )


def _listed(words: list[str]) -> str:
    """``a, b and c``."""
    return ", ".join(words[:-1]) + " and " + words[-1] if len(words) > 1 else words[0]
