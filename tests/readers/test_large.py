"""Large files: read in under a second, fitted in under 1.5 GB."""

import subprocess
import sys
from pathlib import Path

import brdffit
from tests.readers import specimens

PROGRAM = """
import re, sys, brdffit
data = brdffit.load(sys.argv[1])
fit = brdffit.fit("lambert", data, residual="cosine_weighted", starts=1)
status = open("/proc/self/status").read()  # rusage would tell of the parent, too
peak = int(re.search(r"VmHWM:\\s+(\\d+)", status)[1]) / 1e6
print(fit.count, peak)
"""


def test_a_fit_to_all_cells_of_a_merl_file_stays_below_1500_megabytes(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, specimens.merl(tmp_path)],
        cwd=Path(brdffit.__file__).parents[1],
        capture_output=True,
        text=True,
        check=True,
    )
    count, peak = done.stdout.split()
    assert int(count) > 3_000_000
    assert float(peak) < 1.5
