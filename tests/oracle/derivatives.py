"""Values and derivatives of the oracle, by differences in many digits.

A hundred digits and steps of 1e-35 leave thirty correct digits in a difference, even
where a highlight of width 1e-4 meets a direction 1e-6 above the horizon.
Where the two sides disagree the model has a kink, and there is no derivative to check.
"""

import dataclasses

from mpmath import mp, mpf

from tests.oracle.directions import normalize

DIGITS = 100
STEP = mpf(10) ** -35


@dataclasses.dataclass(frozen=True)
class Truth:
    """What the oracle says of one pair of directions; None where there is a kink."""

    value: float
    parameters: dict[str, float | None]
    wi: tuple[float | None, ...]
    wo: tuple[float | None, ...]


def reflectance(model, parameters, wi, wo):
    """``f_r`` for directions of any length, 0 at and below the horizon."""
    wi, wo = normalize(wi), normalize(wo)
    if wi[2] <= 0 or wo[2] <= 0:
        return mpf(0)
    return model(wi, wo, **parameters)


def truth(model, parameters, wi, wo, step=STEP):
    """Value, derivatives by parameters, gradients by both (unnormalised) directions."""
    with mp.workdps(DIGITS):
        parameters = {name: mpf(float(x)) for name, x in parameters.items()}
        wi, wo = (tuple(mpf(float(x)) for x in w) for w in (wi, wo))
        value = reflectance(model, parameters, wi, wo)

        def slope(shifted):
            up, down = (shifted(sign * step) for sign in (1, -1))
            forward, backward = (up - value) / step, (value - down) / step
            scale = max(abs(forward), abs(backward))
            smooth = abs(forward - backward) <= mpf("1e-4") * scale + mpf("1e-9") * abs(
                value
            )
            return float((forward + backward) / 2) if smooth else None

        def moved(w, axis, by):
            return tuple(x + by * (n == axis) for n, x in enumerate(w))

        return Truth(
            float(value),
            {
                name: slope(
                    lambda by, name=name: reflectance(
                        model, parameters | {name: parameters[name] + by}, wi, wo
                    )
                )
                for name in parameters
            },
            tuple(
                slope(
                    lambda by, n=n: reflectance(model, parameters, moved(wi, n, by), wo)
                )
                for n in range(3)
            ),
            tuple(
                slope(
                    lambda by, n=n: reflectance(model, parameters, wi, moved(wo, n, by))
                )
                for n in range(3)
            ),
        )
