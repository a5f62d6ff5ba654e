"""Run all experiments, or those named, each in a process of its own.

    python -m experiments [NAME ...]

A failure is told and stops nothing. In the end the gallery is rebuilt; the exit status
is 1 when an experiment failed.
"""

import subprocess
import sys
import time

import brdffit.names
from experiments import gallery

LONGEST = 900  # seconds after which an experiment is stopped
SHOWN = 3  # last lines that a failed experiment tells


def run(name):
    """Seconds that an experiment took, and what it said last when it failed."""
    begin, why = time.perf_counter(), ""
    command = [sys.executable, "-m", f"experiments.{name}"]
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


def main(names=()):
    """Run them one after another, tell the time of each, and rebuild the gallery."""
    known = gallery.questions()
    for name in names:
        brdffit.names.look_up(known, name, "Experiment")
    begin, failures = time.perf_counter(), []
    for place, name in enumerate(names or known, start=1):
        print(f"[{place}/{len(names or known)}] {name}", end=" ", flush=True)
        seconds, why = run(name)
        print(f"{seconds:.0f} s" + (f", failed:\n{why}" if why else ""), flush=True)
        failures += [name] if why else []
    gallery.main()
    total = (time.perf_counter() - begin) / 60
    print(f"{total:.1f} minutes; failed: {', '.join(failures) or 'none'}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
