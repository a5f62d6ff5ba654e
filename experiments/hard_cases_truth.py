"""Make `hard_cases_truth.npz`: the oracle's values and derivatives at the hard cases.

python -m experiments.hard_cases_truth [MODEL ...]

It takes ten minutes; models named are made anew, others are kept. Numbers carry 32 of
their 53 bits, which is ten digits.
"""

import sys
from pathlib import Path

import numpy as np

from experiments.hard_cases import cases
from tests.oracle import ORACLE
from tests.oracle.derivatives import truth

FILE = Path(__file__).with_suffix(".npz")
TOO_SLOW = ("ggx_multiscatter",)  # a double integral of a double integral
DROPPED_BITS = 21


def rounded(numbers):
    """Doubles without their last bits, which would be most of the file."""
    bits = np.asarray(numbers, np.float64).view(np.uint64)
    kept = np.uint64(0xFFFFFFFFFFFFFFFF << DROPPED_BITS & 0xFFFFFFFFFFFFFFFF)
    return (bits & kept).view(np.float64)


def table(name):
    """One row for each case: value, by parameters, by wi, by wo; NaN at a kink."""
    chosen, wi, wo = cases(name)
    rows = []
    for n in range(len(wi)):
        exact = truth(ORACLE[name], {p: x[n] for p, x in chosen.items()}, wi[n], wo[n])
        row = [exact.value, *exact.parameters.values(), *exact.wi, *exact.wo]
        rows.append([np.nan if x is None else x for x in row])
    return rounded(rows)


def main():
    """Write the file."""
    known = dict(np.load(FILE)) if FILE.exists() else {}
    for name in sys.argv[1:] or sorted(set(ORACLE) - set(TOO_SLOW)):
        known[name] = table(name)
        np.savez_compressed(FILE, **known)
        print(f"{name}: {len(known[name])} cases", flush=True)
    print(f"{FILE.stat().st_size:,} bytes")


if __name__ == "__main__":
    main()
