"""One chunk of a texture, and what fits of its texels give."""

import dataclasses
from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool, Float, Int


@dataclasses.dataclass(frozen=True)
class Texels:
    """Observations of many texels; a last axis of 1 is the same for all of them.

    Attributes:
        wi, wo: Directions in the local frame of each texel.
        weight: What a unit of ``f_r`` adds to the value: light, cosine and visibility.
        value: Observed radiance.
        mask: False where a value must not be used, or None.
        sigma: Standard deviations of the values, or None when they are unknown.

    Raises:
        ValueError: Arrays whose shapes do not fit each other.
    """

    wi: Float[np.ndarray, "observation 3 _"]
    wo: Float[np.ndarray, "observation 3 _"]
    weight: Float[np.ndarray, "observation _ _"]
    value: Float[np.ndarray, "observation channel texel"]
    mask: Bool[np.ndarray, "observation _ _"] | None = None
    sigma: Float[np.ndarray, "observation _ _"] | None = None

    def __post_init__(self) -> None:
        """Refuse what does not fit the values."""
        observations, channels, texels = self.value.shape
        for name, middle in (
            ("wi", (3,)),
            ("wo", (3,)),
            ("weight", (1, channels)),
            ("mask", (1, channels)),
            ("sigma", (1, channels)),
        ):
            array = getattr(self, name)
            if array is None:
                continue
            shape = array.shape
            fits = len(shape) == 3 and shape[0] == observations
            if not (fits and shape[1] in middle and shape[2] in (1, texels)):
                wanted = " or ".join(map(str, middle))
                raise ValueError(
                    f"`{name}` must have the shape ({observations}, {wanted}, 1 or "
                    f"{texels}) to go with `value`, but has {shape}."
                )

    def __len__(self) -> int:
        return self.value.shape[2]

    @property
    def channels(self) -> int:
        """Number of channels of the values."""
        return self.value.shape[1]


@dataclasses.dataclass(frozen=True)
class TexelFits:
    """What was found for each texel; all numbers are finite but standard errors.

    Attributes:
        parameters: Values by name, with a channel axis of 1 where channels share one.
        standard_errors: Their standard errors in the same shapes; infinite where the
            data cannot tell the parameter, 0 where it was fixed.
        rms: Root mean square of the weighted residuals; 0 without any observation.
        converged: True where nothing that could be seen was left to gain; False where
            a texel has fewer usable values than unknowns.
        steps: Evaluations of the model with its derivatives.
        at_bound: True where a parameter ended on one of its bounds.
    """

    parameters: Mapping[str, Float[np.ndarray, "_ texel"]]
    standard_errors: Mapping[str, Float[np.ndarray, "_ texel"]]
    rms: Float[np.ndarray, " texel"]
    converged: Bool[np.ndarray, " texel"]
    steps: Int[np.ndarray, " texel"]
    at_bound: Bool[np.ndarray, " texel"]
