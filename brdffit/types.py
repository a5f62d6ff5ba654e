"""The shapes that travel through brdffit, each named once.

One pair of directions is the unit of computation: a model is written for a single
``(wi, wo)`` and batched from outside with ``jax.vmap``.
"""

from typing import TypeAlias

import jax
import numpy as np
from jaxtyping import Array, Bool, Float, Int

Scalar: TypeAlias = Float[Array, ""]
Direction: TypeAlias = Float[Array, "3"]  # unit vector in the shading frame
Spectrum: TypeAlias = Float[Array, " channel"]  # RGB, or any number of bands

AnyArray: TypeAlias = jax.Array | np.ndarray  # data: read by numpy, computed by jax
Vectors: TypeAlias = Float[AnyArray, "sample 3"]
Values: TypeAlias = Float[AnyArray, "sample channel"]
Mask: TypeAlias = Bool[AnyArray, "sample channel"]
Image: TypeAlias = Float[AnyArray, "row column channel"]
Index: TypeAlias = Int[AnyArray, " sample"]
