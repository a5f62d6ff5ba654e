"""Run all experiments, or those named, each in a process of its own.

    python -m experiments [NAME ...]

Those that measure error against time run one after another, with nothing beside them;
of the others each has one core to itself, as many at a time as there are cores. A
failure is told and stops nothing. In the end the gallery is rebuilt; the exit status is
1 when an experiment failed.
"""

import os
import queue
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from brdffit.names import look_up
from experiments import gallery

LONGEST = 900  # seconds after which an experiment is stopped
SHOWN = 3  # last lines that a failed experiment tells
ON_CORES = """
import os, runpy
os.sched_setaffinity(0, {cores})
runpy.run_module("experiments.{name}", run_name="__main__")
"""


def run(name, cores):
    """Seconds that an experiment took, and what it said last when it failed."""
    begin, why = time.perf_counter(), ""
    command = [sys.executable, "-c", ON_CORES.format(cores=set(cores), name=name)]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=LONGEST, check=False
        )
    except subprocess.TimeoutExpired:
        why = f"stopped after {LONGEST} s"
    else:
        if done.returncode != 0:
            last = done.stderr.strip().splitlines()[-SHOWN:]
            why = "\n".join(last) or f"exit status {done.returncode}"
    return time.perf_counter() - begin, why


class Progress:
    """A line for each experiment that has ended.

    Attributes:
        count: How many there are.
        failures: Names of those that failed.
    """

    def __init__(self, count):
        """Nothing has ended yet."""
        self.count, self.ended, self.failures = count, 0, []

    def tell(self, name, seconds, why):
        """One more has ended."""
        self.ended += 1
        self.failures += [name] if why else []
        words = f"{seconds:.0f} s" + (f", failed:\n{why}" if why else "")
        print(f"[{self.ended}/{self.count}] {name} {words}", flush=True)


def main(names=()):
    """Run them, tell the time of each, and rebuild the gallery."""
    known, alone = gallery.questions(), gallery.timed()
    for name in names:
        look_up(known, name, "Experiment")
    chosen = list(names or known)
    begin, progress = time.perf_counter(), Progress(len(chosen))
    every, free = sorted(os.sched_getaffinity(0)), queue.SimpleQueue()
    for name in chosen:
        if name in alone:
            progress.tell(name, *run(name, every))
    for core in every:
        free.put(core)

    def on_one_core(name):
        core = free.get()
        progress.tell(name, *run(name, [core]))
        free.put(core)

    with ThreadPoolExecutor(len(every)) as pool:
        list(pool.map(on_one_core, [name for name in chosen if name not in alone]))
    gallery.main()
    total = (time.perf_counter() - begin) / 60
    print(f"{total:.1f} minutes; failed: {', '.join(progress.failures) or 'none'}")
    return 1 if progress.failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
