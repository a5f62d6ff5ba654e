"""A child process that reads files and is watched: what it said, time, memory.

Linux tells the largest memory of a process since it was last asked to forget it, so one
child serves many files and every one of them is charged with what it took.
"""

import dataclasses
import json
import select
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PATIENCE = 60  # seconds, after which a reader is taken to hang
MEGABYTES, SECONDS = 200, 10  # above the size of the file; longest

PROGRAM = """
import contextlib, gc, io, json, os, re, sys, time, traceback, warnings
answers = os.fdopen(os.dup(1), "w")
nowhere = os.open(os.devnull, os.O_WRONLY)
os.dup2(nowhere, 1), os.dup2(nowhere, 2)
import brdffit
from brdffit.cli import main

def megabytes(name):
    with open("/proc/self/status") as status:
        return int(re.search(name + r":\\s+(\\d+)", status.read())[1]) / 1000

def watched(act):
    gc.collect()
    with open("/proc/self/clear_refs", "w") as forget:
        forget.write("5")
    before, start = megabytes("VmRSS"), time.perf_counter()
    outcome = act()
    return outcome, time.perf_counter() - start, megabytes("VmHWM") - before

def read(path):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            brdffit.load(path)
        return "read", ""
    except (ValueError, OSError) as error:
        return "refused", str(error)
    except BaseException:
        return "traceback", traceback.format_exc()

def told(path):
    words, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(words), contextlib.redirect_stderr(errors):
        try:
            status = main(["info", path, "--json"])
        except BaseException:
            return -1, traceback.format_exc()
    return status, errors.getvalue()

for number, line in enumerate(sys.stdin):
    if number == 1:
        gc.freeze()  # all that is loaded by now, which takes long to look through
    (outcome, sentence), seconds, peak = watched(lambda: read(json.loads(line)))
    status, said = told(json.loads(line))
    print(json.dumps([outcome, sentence, seconds, peak, status, said]), file=answers)
    answers.flush()
"""


@dataclasses.dataclass(frozen=True)
class Verdict:
    """What became of one file.

    Attributes:
        outcome: read, refused, traceback, crash or hang.
        sentence: Why it was refused.
        seconds: Time that reading took.
        megabytes: Most memory that reading took.
        status: What the command line returned.
        said: What it wrote to standard error.
    """

    outcome: str
    sentence: str = ""
    seconds: float = 0.0
    megabytes: float = 0.0
    status: int = 0
    said: str = ""

    def wrong(self, size, name):
        """What is against the rules, or an empty string.

        Args:
            size: Bytes of the file, or of all files of a folder.
            name: What the sentence must name.
        """
        if self.outcome not in ("read", "refused"):
            return f"{self.outcome}: {self.sentence}"
        if self.seconds > SECONDS:
            return f"took {self.seconds:.1f} s"
        if self.megabytes > MEGABYTES + size / 1e6:
            return f"took {self.megabytes:.0f} MB"
        if self.status != {"read": 0, "refused": 2}[self.outcome]:
            return f"{self.outcome}, but the command line said {self.status}"
        if self.outcome == "read":
            return ""
        lines = self.said.splitlines()
        if len(lines) != 1 or not self.said.startswith("brdffit: "):
            return f"not one sentence: {self.said}"
        if not self.sentence.endswith((".", "?")) or len(self.sentence) > 1500:
            return f"no sentence: {self.sentence}"
        return "" if name in self.sentence else f"names no file: {self.sentence}"


class Guard:
    """The child, begun again when it dies; used in a ``with`` statement."""

    def __enter__(self):
        self.child = None
        return self

    def __exit__(self, *_):
        self.end()

    def end(self):
        """Stop the child."""
        if self.child is not None:
            self.child.kill()
            self.child.communicate()
            self.child = None

    def begin(self):
        """Start a child."""
        self.child = subprocess.Popen(
            [sys.executable, "-c", PROGRAM],
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def read(self, path):
        """The verdict on one file."""
        if self.child is None:
            self.begin()
        self.child.stdin.write(json.dumps(str(path)) + "\n")
        self.child.stdin.flush()
        ready, _, _ = select.select([self.child.stdout], [], [], PATIENCE)
        line = self.child.stdout.readline() if ready else ""
        if line:
            return Verdict(*json.loads(line))
        self.end()
        return Verdict("crash" if ready else "hang")
