"""How do time and memory grow with the samples, and time with the starts?

`brdffit.fit` of tables of 1,000 to 10 million pairs of directions, each in a process of
its own whose peak memory is read; and of the sphere of `sphere_fit` from 1 to 256
starts. Every fit is run once before it is timed. Answers are checked against the truth.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np

from benchmarks.measure import use_one_core
from benchmarks.record import RESULTS, facts
from brdffit.plots.style import COLOURS, new_figure
from experiments.record import Record, styled

MODEL = "ggx"
SAMPLES = (10**3, 10**4, 10**5, 10**6, 10**7)
STARTS = (1, 4, 16, 64, 256)
LINEAR = 1e5  # samples from which on time should grow in proportion
TURNS = 3


def one(samples: int, starts: int, precision: str, turns: int) -> dict:
    """Time and memory of one size, measured in a process of its own."""
    task = {
        "samples": samples,
        "starts": starts,
        "precision": precision,
        "turns": turns,
    }
    found = subprocess.run(
        [sys.executable, "-m", "benchmarks.growth_of_one", json.dumps(task)],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[1],
    )
    return json.loads(found.stdout.splitlines()[-1])


def slope(rows: list[dict], least: float = LINEAR) -> float:
    """Slope of log time over log samples, of one precision, from ``least`` on."""
    seen = [row for row in rows if row["samples"] >= least]
    logs = np.log([[row["samples"], row["seconds"]] for row in seen])
    return float(np.polyfit(logs[:, 0], logs[:, 1], 1)[0])


@styled
def chart(rows):
    """Time and memory over samples, and time over starts."""
    figure = new_figure(10.5, 3.4)
    time, memory, starts = figure.subplots(1, 3)
    for precision, colour in zip(("float32", "float64"), COLOURS, strict=False):
        own = [row for row in rows if row["precision"] == precision]
        sizes = [row for row in own if row["varied"] == "samples"]
        counts = [row for row in own if row["varied"] == "starts"]
        style = {"color": colour, "marker": "o", "markersize": 4, "label": precision}
        x = [row["samples"] for row in sizes]
        time.plot(x, [row["seconds"] for row in sizes], **style)
        memory.plot(x, [row["peak_mb"] for row in sizes], **style)
        starts.plot(
            [row["starts"] for row in counts],
            [1e3 * row["seconds"] for row in counts],
            **style,
        )
    memory.plot(
        x, [row["data_mb"] for row in sizes], color="black", label="data", linewidth=1
    )
    for axes in (time, memory, starts):
        axes.set(xscale="log", yscale="log")
        axes.legend()
    time.set(xlabel="samples", ylabel="time of one fit [s]")
    memory.set(xlabel="samples", ylabel="peak memory above that before the fit [MB]")
    starts.set(xlabel="starts", ylabel="time of one fit [ms]")
    figure.supxlabel("All axes have log scales", size=8)
    return figure


def main(
    folder=RESULTS / "growth",
    samples=SAMPLES,
    starts=STARTS,
    turns=TURNS,
    sphere=10_000,
):
    """Measure all sizes in both precisions.

    Args:
        folder: Where the results go.
        samples: Numbers of samples.
        starts: Numbers of starts.
        turns: Turns of fits below a million samples; larger ones are run once.
        sphere: Samples of the fits from several starts.
    """
    record = Record(folder)
    rows = []
    for precision in ("float32", "float64"):
        for count in samples:
            often = turns if count < 10**6 else 1
            rows.append({"varied": "samples"} | one(count, 1, precision, often))
        for count in starts:
            rows.append({"varied": "starts"} | one(sphere, count, precision, turns))
        print(precision, "done", flush=True)
    record.table(rows)
    record.figure(chart(rows))
    slopes = {
        p: slope([r for r in rows if r["precision"] == p and r["varied"] == "samples"])
        for p in ("float32", "float64")
    }
    record.close(slopes=slopes, **facts(turns))
    return rows, slopes


if __name__ == "__main__":
    use_one_core()
    main()
