"""How much do a second worker, a chunk and a scheduler cost a fit of a texture?

A texture of 65,536 texels a chunk, 24 observations in RGB under lights of its own for
every texel, fitted with `ggx` by one and by two worker processes of `dask.distributed`,
each on a core of its own. The two clusters take turns. Beside them, on one core and
without a cluster, the parts of a chunk; and how many empty tasks a second the scheduler
hands out. `docs/clusters.md` plans with these figures.
"""

import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from importlib.metadata import version
from pathlib import Path

import numpy as np
from distributed import Client, LocalCluster

import brdffit
from benchmarks.measure import ALL_CORES
from benchmarks.record import RESULTS, facts
from brdffit.batch.cluster import outcomes
from brdffit.batch.ledger import open_ledger, seal
from brdffit.batch.stack import ZarrStack, save_stack
from brdffit.batch.texture import FITS, content_of, files_of, open_results
from brdffit.fit.texels import Texels
from brdffit.fit.texture import fit_texels
from brdffit.plots.style import COLOURS, MUTED, new_figure
from brdffit.render.texture import shade_texels
from experiments.record import Record as Results, styled

MODEL = "ggx"
MAPS = {"diffuse": (3, 0.05, 0.6), "f0": (3, 0.03, 0.5), "alpha": (1, 0.1, 0.6)}
SEED = 1
OBSERVATIONS = 24
NOISE = 0.01  # relative
CHUNK = 65_536
CHUNKS = 16
TURNS = 3
EMPTY = 5000  # empty tasks
THREADS = 64  # of workers that do empty tasks


def texture(texels: int) -> Texels:
    """Texels of random materials, seen from above under random lights."""
    draw = np.random.default_rng(SEED)

    def directions(lowest: float, *shape: int) -> np.ndarray:
        z, turn = draw.uniform(lowest, 1, shape), 2 * np.pi * draw.random(shape)
        radius = np.sqrt(1 - z * z)
        found = np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)
        return found.astype(np.float32)

    wi = directions(0.3, OBSERVATIONS, texels)
    wo = directions(0.8, OBSERVATIONS, 1)
    maps = {
        name: draw.uniform(low, high, (channels, texels)).astype(np.float32)
        for name, (channels, low, high) in MAPS.items()
    }
    brdf, weight = brdffit.MODELS[MODEL](), np.ascontiguousarray(wi[:, 2:])
    value = np.asarray(shade_texels(brdf, maps, wi, wo, weight))
    noise = 1 + NOISE * draw.standard_normal(value.shape, np.float32)
    return Texels(wi, wo, weight, value * noise)


def workers(count: int, threads: int = 1) -> LocalCluster:
    """A cluster whose workers are processes with a core each."""
    cluster = LocalCluster(
        n_workers=count,
        threads_per_worker=threads,
        dashboard_address=":0",
        memory_limit=0,
    )
    with Client(cluster, set_as_default=False) as client:
        names = list(client.scheduler_info()["workers"])
        for core, name in zip(sorted(ALL_CORES), names, strict=False):
            client.run(os.sched_setaffinity, 0, {core}, workers=[name])
    return cluster


def fit(stack: ZarrStack, out: Path, address: str, chunk: int) -> float:
    """Seconds of a fit on a cluster."""
    shutil.rmtree(out, ignore_errors=True)
    begin = time.perf_counter()
    tally = brdffit.fit_texture(MODEL, stack, out, cluster=address, chunk=chunk)
    seconds = time.perf_counter() - begin
    assert tally.done == stack.texels, tally.sentence
    return seconds


def steps(stack: ZarrStack, out: Path, chunk: int) -> Iterator[tuple[str, Callable]]:
    """The parts of a chunk by name; `out` is a finished run, which is not changed."""
    texels, group = stack.read(0, chunk), out / FITS
    arrays = open_results(group)
    content = {name: array[..., :chunk] for name, array in arrays.items()}
    files = files_of(group, arrays, 0)

    def write() -> None:
        for name, array in open_results(group).items():
            array[..., :chunk] = content[name]

    yield "read", lambda: ZarrStack(stack.path).read(0, chunk)
    yield "hash of the input", lambda: content_of(texels)
    yield "fit", lambda: fit_texels(MODEL, texels, threads=1)
    yield "write, wait for the disk, checksum", lambda: (write(), seal(files))
    with open_ledger(out, resume=True) as ledger:
        record = next(iter(ledger.records.values()))
        yield "ledger", lambda: ledger.commit(record)


def timed(call: Callable[[], object], turns: int) -> list[float]:
    """Seconds of each turn, after one that is not counted."""
    call()
    found = []
    for _ in range(turns):
        begin = time.perf_counter()
        call()
        found.append(time.perf_counter() - begin)
    return found


def row(
    what: str, unit: str, values: list[float], digits: int = 4
) -> dict[str, object]:
    """Median, least and most of the turns."""
    three = np.median(values), min(values), max(values)
    names = ("median", "least", "most")
    shown = {n: float(f"{x:.{digits}g}") for n, x in zip(names, three, strict=True)}
    return {"what": what, "unit": unit} | shown


def main(
    folder=RESULTS / "cluster",
    chunk=CHUNK,
    chunks=CHUNKS,
    turns=TURNS,
    empty=EMPTY,
):
    """Measure throughput, parts of a chunk, and the scheduler."""
    results = Results(folder, SEED)
    rows = []
    with ExitStack() as stack_of, tempfile.TemporaryDirectory() as place:
        part, home = texture(chunk), Path(place)
        stack = save_stack(home / "stack.zarr", (part for _ in range(chunks)))
        one, two = (stack_of.enter_context(workers(count)) for count in (1, 2))
        seconds = {one: [], two: []}
        for turn in range(turns + 1):  # the first compiles
            for cluster in (one, two) if turn % 2 else (two, one):
                address = cluster.scheduler_address
                taken = fit(stack, home / "out", address, chunk)
                seconds[cluster] += [taken] if turn else []
        for count, cluster in ((1, one), (2, two)):
            rates = [chunk * chunks / taken for taken in seconds[cluster]]
            rows.append(row(f"{count} worker{'s' * (count > 1)}", "texels/s", rates))
        ratios = np.divide(seconds[one], seconds[two])
        rows.append(row("two workers over one", "times", list(ratios)))
        each = [1e3 * taken / chunks for taken in seconds[one]]
        rows.append(row("a chunk by one worker", "ms", each))
        for name, call in steps(stack, home / "out", chunk):
            rows.append(row(name, "ms", [1e3 * s for s in timed(call, turns)]))
        print("chunks done", flush=True)
    with workers(2, THREADS // 2) as cluster:
        address = cluster.scheduler_address

        def hand_out() -> None:
            assert sum(outcomes(abs, range(empty), address)) == sum(range(empty))

        rates = [empty / taken for taken in timed(hand_out, turns)]
        rows.append(row("empty tasks", "tasks/s", rates))
    results.table(rows)
    results.figure(chart(rows))
    packages = {name: version(name) for name in ("dask", "distributed", "zarr")}
    results.close(cluster_packages=packages, chunk=chunk, chunks=chunks, **facts(turns))
    return rows


@styled
def chart(rows):
    """Throughput by workers, and what a chunk takes beside its fit."""
    value = {line["what"]: line["median"] for line in rows}
    figure = new_figure(8.6, 2.9)
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.9))
    rates = [value["1 worker"], value["2 workers"]]
    bars = left.bar(["1 worker", "2 workers"], rates, color=COLOURS[0], width=0.6)
    left.bar_label(bars, [f"{rate:,.0f}" for rate in rates], size=8, padding=2)
    left.set(ylabel="texels per second", ylim=(0, 1.15 * max(rates)))
    left.set_title(f"a second worker: x {value['two workers over one']:.2f}")
    parts = [line for line in rows if line["unit"] == "ms"][1:]
    names = [line["what"] for line in parts]
    times = [line["median"] for line in parts]
    colours = [COLOURS[0] if name == "fit" else MUTED for name in names]
    bars = right.barh(names, times, color=colours, height=0.6)
    texts = [f"{time:,.0f}" if time >= 100 else f"{time:.3g}" for time in times]
    right.bar_label(bars, texts, size=8, padding=3)
    right.invert_yaxis()
    right.set(
        xscale="log",
        xlim=(0.5 * min(times), 4 * max(times)),
        xlabel="ms a chunk, log scale",
    )
    right.set_title("parts of a chunk, on one core")
    return figure


if __name__ == "__main__":
    main()
