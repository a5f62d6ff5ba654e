"""What an experiment leaves behind: a table, figures, and how they came about."""

import csv
import hashlib
import os
import platform
import subprocess
import time
from importlib.metadata import version
from pathlib import Path

import matplotlib
import tomli_w
from PIL import Image

from brdffit.plots import style

RESULTS = Path(__file__).parents[1] / "results"
PACKAGES = ("brdffit", "jax", "jaxlib", "numpy", "matplotlib", "mpmath")
DIGITS = 6
DITHER = Image.Dither.FLOYDSTEINBERG
RARE = Image.Quantize.MAXCOVERAGE  # keeps the ends of a colour scale, however rare


class Record:
    """A folder of results, and the time since it was opened.

    Args:
        folder: Where to write; made if it is not there.
        seed: Of the random numbers, if there are any.
    """

    def __init__(self, folder, seed=None):
        """Start the clock."""
        self.folder, self.seed = Path(folder), seed
        self.started, self.written = time.perf_counter(), []
        self.folder.mkdir(parents=True, exist_ok=True)

    def table(self, rows, name="table"):
        """Print rows, which are dictionaries with the same keys, and write them."""
        texts = [
            {key: shown(x) for key, x in row.items() if key is not None} for row in rows
        ]
        self.written.append(self.folder / f"{name}.csv")
        with open(self.written[-1], "w", newline="") as file:
            writer = csv.DictWriter(file, texts[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(texts)
        wide = {key: max(len(key), *(len(t[key]) for t in texts)) for key in texts[0]}
        print("  ".join(key.ljust(wide[key]) for key in wide))
        for text in texts:
            print("  ".join(text[key].rjust(wide[key]) for key in wide))

    def figure(self, figure, name="figure"):
        """Write a figure as PDF and as PNG, which is small with 256 colours."""
        for path in style.save(figure, self.folder, name):
            self.written.append(path)
            if path.suffix == ".png":
                full = Image.open(path).convert("RGB")
                few = full.quantize(palette=full.quantize(method=RARE), dither=DITHER)
                few.save(path, optimize=True)

    def picture(self, image, name):
        """Write an image of Pillow as PNG."""
        self.written.append(self.folder / f"{name}.png")
        image.save(self.written[-1], optimize=True)

    def close(self, **facts):
        """Write `run.toml`: facts, versions, machine, seed, commit, time and files."""
        run = {
            "seconds": round(time.perf_counter() - self.started, 1),
            "commit": commit(),
            "python": platform.python_version(),
            "processor": processor(),
            "threads": len(os.sched_getaffinity(0)),
            "packages": {package: version(package) for package in PACKAGES},
        }
        if self.seed is not None:
            run["seed"] = self.seed
        run["sha256"] = {path.name: digest(path) for path in self.written}
        path = self.folder / "run.toml"
        path.write_text(tomli_w.dumps(facts | run), encoding="utf-8")


def digest(path):
    """SHA-256 of a file, by which it is known for what was written."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def shown(x):
    """A number to six digits, anything else as it is."""
    return f"{x:.{DIGITS}g}" if isinstance(x, float) else str(x)


def processor():
    """Name of the processor."""
    info = Path("/proc/cpuinfo")
    names = [
        line.partition(":")[2].strip()
        for line in (info.read_text().splitlines() if info.exists() else [])
        if line.startswith("model name")
    ]
    return names[0] if names else platform.processor() or platform.machine()


def commit():
    """Commit that the package was at, or a sentence that there is none."""
    try:
        found = subprocess.run(
            ["git", "rev-parse", "--short=12", "HEAD"],
            cwd=RESULTS.parent,
            capture_output=True,
            text=True,
            check=True,
        )
    except (OSError, subprocess.CalledProcessError):
        return "not in a repository"
    return found.stdout.strip()


styled = matplotlib.rc_context(style.LOOK)
