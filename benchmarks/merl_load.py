"""How fast is a MERL file read, and how much memory do reading and a fit take?

A file of real size, 35 MB with 1.46 million cells, is written from a known model with
noise of 1 %. Each row is measured in processes of their own, begun anew for every turn:
the time of `brdffit.load` with imports done, and the largest memory of the whole
process, imports included. The issue asks for less than 1 s and 1,500 MB.
"""

import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.problems import write_merl
from benchmarks.record import RESULTS
from experiments.record import Record

TURNS = 5
TASKS = {
    "import alone": "import brdffit.fit, brdffit.readers",
    "load": "brdffit.load(path)",
    "fit lambert to all": "brdffit.fit('lambert', brdffit.load(path))",
    "fit ggx to all": "brdffit.fit('ggx', brdffit.load(path))",
    "fit ggx to all, log": "brdffit.fit('ggx', brdffit.load(path), residual='log')",
}
PROGRAM = """
import json, re, sys, time, brdffit, brdffit.fit, brdffit.readers
path, task = sys.argv[1:]
start = time.perf_counter()
exec(task)
seconds = time.perf_counter() - start
with open("/proc/self/status") as status:
    peak = int(re.search(r"VmHWM:\\\\s+(\\\\d+)", status.read())[1]) / 1000
print(json.dumps([seconds, peak]))
""".replace("\\\\", "\\")


def measured(task, path):
    """Seconds and megabytes of one process."""
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(path), task],
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout.splitlines()[-1])


def main(folder=RESULTS / "merl_load", turns=TURNS, tasks=TASKS):
    """Write the table.

    Args:
        folder: Where the results go.
        turns: Processes for each task; fits take one.
        tasks: Statements by what they are called in the table.
    """
    record, rows = Record(folder), []
    with tempfile.TemporaryDirectory() as temporary:
        path = Path(temporary) / "stand_in.binary"
        write_merl("ggx", path)
        for name, task in tasks.items():
            count = 1 if "fit" in name else turns
            found = [measured(task, path) for _ in range(count)]
            seconds, peaks = zip(*found, strict=True)
            rows.append(
                {
                    "task": name,
                    "turns": count,
                    "median_seconds": round(statistics.median(seconds), 3),
                    "longest_seconds": round(max(seconds), 3),
                    "peak_megabytes": round(max(peaks)),
                }
            )
    record.table(rows)
    record.close(megabytes=35, cells=1_458_000)
    return rows


if __name__ == "__main__":
    main()
