"""Timings of brdffit, each beside its peers in the same run; one file per task."""

import os

# One thread for each contestant unless it says otherwise. Linear algebra libraries
# read this when NumPy is loaded; idle threads of theirs would be charged to others.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
