"""Does memory stay flat, and time in proportion, from 0.25 to 16 million texels?

`brdffit.fit_texture` of textures of the kind of `benchmarks.cluster`, read from the
disk and written to it chunk by chunk, each size in a process of its own whose peak
memory is read. What is on the disk is a few chunks, read again and again; every run
first fits one chunk, so that compiling is no part of its time.
"""

import dataclasses
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator

import brdffit
from benchmarks.cluster import CHUNK, MODEL, SEED, texture
from benchmarks.record import RESULTS, facts
from brdffit.batch.stack import ZarrStack, save_stack
from brdffit.fit.texels import Texels
from brdffit.plots.style import COLOURS, entitle, new_figure
from experiments.record import Record, styled

SIZES = tuple(2**k for k in (18, 20, 22, 24))
DISTINCT = 4  # chunks on the disk


@dataclasses.dataclass(frozen=True)
class Repeated:
    """A stack whose texels begin again after its last chunk."""

    stack: ZarrStack
    texels: int
    shape: None = None

    @property
    def channels(self) -> int:
        """Number of channels."""
        return self.stack.channels

    def read(self, start: int, stop: int) -> Texels:
        """The texels from one to before another, within a chunk."""
        first = start % self.stack.texels
        return self.stack.read(first, first + stop - start)


def measure(path: str, texels: int, chunk: int) -> dict[str, float]:
    """Seconds and peak memory of one size, in this process."""
    stack = ZarrStack(Path(path))
    with tempfile.TemporaryDirectory() as place:
        for name, count in (("first", chunk), ("timed", texels)):
            begin = time.perf_counter()
            source, out = Repeated(stack, count), Path(place, name)
            tally = brdffit.fit_texture(MODEL, source, out, chunk=chunk)
            seconds = time.perf_counter() - begin
            assert tally.done == count, tally.sentence
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10
    return {"seconds": seconds, "texels_per_s": texels / seconds, "peak_mb": peak}


def one(path: str, texels: int, chunk: int) -> dict[str, float]:
    """Seconds and peak memory of one size, in a process of its own."""
    found = subprocess.run(
        [sys.executable, "-m", "benchmarks.streaming", path, str(texels), str(chunk)],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[1],
    )
    return json.loads(found.stdout.splitlines()[-1])


def main(folder=RESULTS / "streaming", sizes=SIZES, chunk=CHUNK):
    """Measure all sizes, each in a process of its own."""
    record, rows = Record(folder, SEED), []
    with tempfile.TemporaryDirectory() as place:
        path = str(Path(place, "stack.zarr"))
        part = texture(chunk)
        save_stack(path, (part for _ in range(DISTINCT)))
        for texels in sizes:
            rows.append({"texels": texels} | one(path, texels, chunk))
            print(texels, "done", flush=True)
    record.table(rows)
    logs = np.log([[row["texels"], row["seconds"]] for row in rows])
    slope = float(np.polyfit(logs[:, 0], logs[:, 1], 1)[0])
    memory = [row["peak_mb"] for row in rows]
    growth = max(memory) / min(memory)
    finding = (
        f"Time grows with the power {slope:.2f} of the number of texels, memory by "
        f"{growth - 1:.0%}"
    )
    record.figure(chart(rows, finding))
    record.close(
        finding=finding + ".",
        slope=slope,
        memory_growth=growth,
        chunk=chunk,
        **facts(1),
    )
    return rows


@styled
def chart(rows, title):
    """Time and memory over the number of texels."""
    figure = new_figure(7.2, 2.9)
    left, right = figure.subplots(1, 2)
    x = [row["texels"] / 2**20 for row in rows]
    style = {"color": COLOURS[0], "marker": "o", "markersize": 4}
    left.plot(x, [row["seconds"] for row in rows], **style)
    left.set(xscale="log", yscale="log", ylabel="time of a fit [s], log scale")
    right.plot(x, [row["peak_mb"] for row in rows], **style)
    right.set(xscale="log", ylabel="peak memory of the process [MB]")
    right.set_ylim(0, 1.25 * max(row["peak_mb"] for row in rows))
    for axes in (left, right):
        axes.set_xlabel("texels [$2^{20}$], log scale")
        axes.set_xticks(x, [f"{millions:g}" for millions in x])
        axes.xaxis.set_minor_locator(NullLocator())
    left.yaxis.set_major_locator(LogLocator(subs=(1, 3)))
    left.yaxis.set_major_formatter("{x:g}")
    left.yaxis.set_minor_formatter(NullFormatter())
    entitle(figure, title)
    return figure


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(measure(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))))
    else:
        main()
