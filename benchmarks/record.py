"""What a run of a benchmark tells beside its table: machine, load and peers."""

import os
import subprocess
from importlib.metadata import version
from pathlib import Path

from benchmarks import ceres

RESULTS = Path(__file__).parent / "results"
PEERS = ("optimistix", "lineax", "equinox", "scipy")


def facts(turns: int) -> dict[str, object]:
    """For `run.toml`: how often, on how busy a machine, beside which peers."""
    return {
        "turns": turns,
        "cores": len(os.sched_getaffinity(0)),
        "load": [round(load, 1) for load in os.getloadavg()],
        "peers": {name: version(name) for name in PEERS} | {"ceres": _ceres()},
    }


def _ceres() -> str:
    if why := ceres.why_absent():
        return why
    text = (ceres.HEADER.parent / "version.h").read_text()
    numbers = [
        line.split()[-1]
        for line in text.splitlines()
        if "#define CERES_VERSION_" in line
    ]
    compiler = subprocess.run(
        [ceres.COMPILER, "-dumpfullversion"], capture_output=True, text=True, check=True
    ).stdout.strip()
    options = " ".join(ceres.OPTIONS)
    return f"{'.'.join(numbers[:3])}, {ceres.COMPILER} {compiler} {options}"
