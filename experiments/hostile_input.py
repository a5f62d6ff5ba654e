"""Does any damaged or lying file bring a reader down, or make it slow or large?

Every reader gets its specimen of the tests, and measured files where there are any: cut
at every kilobyte, with bits of the header flipped, with words of it as counts that
cannot be, with numbers of a text that are none; and then the traps of the tests, which
are bombs, devices, links and paths out of a folder. A child process reads them, first
by `brdffit.load`, then by ``brdffit info``. Wrong is all but a result or one sentence
that names the file, more than 10 s, or more memory than 200 MB above the size of the
file. Of kinds other than cuts as many are drawn as `MOST`, a tenth of them from files
above a megabyte; of the 34,000 cuts of a MERL file two thousand.

    python -m experiments.hostile_input

takes a few minutes on one core. A smaller share of it is a test.
"""

import os
import random
import sys
import tempfile
from pathlib import Path

import numpy as np

from brdffit.plots.style import COLOURS, entitle, new_figure
from experiments import captions
from experiments.merl_standins import DATA
from experiments.record import RESULTS, Record, styled
from tests.readers.guard import Guard
from tests.readers.mutants import KINDS, damaged
from tests.readers.specimens import SPECIMENS, files_of
from tests.readers.traps import TRAPS

MOST = 60  # damages of one kind, other than cuts, to one file
CUTS = 2000  # of one file
OUTCOMES = ("read", "refused", "wrong")
LARGE = 1_000_000  # bytes, beyond which every damage costs a copy
MEASURED = (
    "ualoft/AnoBlackEC1onAlum.txt",
    "ualoft/AnoBlackEC1onAlum.bsdf",
    "nist_ptfe/ptfe_regular_532nm.csv",
    "rgl/chm_mint_rgb.bsdf",
    "curet/abrdf.dat",
)


class Tally:
    """What became of the files of one row of the table."""

    def __init__(self, **row):
        """Nothing yet."""
        self.row = row
        self.verdicts, self.wrong, self.above = [], [], []

    def add(self, verdict, size, name):
        """Count a verdict on files of so many bytes."""
        self.verdicts.append(verdict)
        self.above.append(verdict.megabytes - size / 1e6)
        if wrong := verdict.wrong(size, name):
            self.wrong.append(wrong)
            print(f"WRONG {self.row}: {wrong}", file=sys.stderr, flush=True)

    def counted(self):
        """The row of the table."""
        outcomes = [verdict.outcome for verdict in self.verdicts]
        return self.row | {
            "files": len(outcomes),
            "read": outcomes.count("read"),
            "refused": outcomes.count("refused"),
            "wrong": len(self.wrong),
            "most_megabytes_above_size": round(max(*self.above, 0.0), 1),
            "longest_seconds": round(max(v.seconds for v in self.verdicts), 2),
        }


def size_of(path):
    """Bytes of a file, with the scene beside it, or of a folder."""
    return sum(file.stat().st_size for file in files_of(path) if file.is_file())


def mutants(guard, path, told, most, cuts):
    """A tally for each kind of damage to each kind of file of a specimen."""
    assert guard.read(path).outcome == "read"
    tallies = {}
    for file in files_of(path):
        whole, size = file.read_bytes(), size_of(path)
        for kind, damages in KINDS.items():
            chosen = damages(whole)
            limit = cuts if kind == "cuts" else most
            if len(whole) > LARGE and kind != "cuts":
                limit = max(limit // 10, 1)
            if len(chosen) > limit:
                chosen = sorted(random.Random(0).sample(chosen, limit))
            tally = tallies.setdefault(kind, Tally(file=told, damage=kind))
            for damage in reversed(chosen):  # the longest first
                if kind == "cuts":
                    os.truncate(file, damage[0])
                else:
                    file.write_bytes(damaged(whole, damage))
                tally.add(guard.read(path), size, path.stem)
            file.write_bytes(whole)
    return [tally.counted() for tally in tallies.values() if tally.verdicts]


def copy(source, folder):
    """A measured file, with what belongs to it, where it may be damaged."""
    for file in (source, source.parent / "table.txt"):
        if file.is_file():
            (folder / file.name).write_bytes(file.read_bytes())
    return folder / source.name


@styled
def chart(rows, title):
    """What became of the damaged files of each reader, and of all traps."""
    counts = {}
    for row in rows:
        name = "traps" if row["damage"] == "trap" else row["file"]
        counts.setdefault(name, []).append([row[what] for what in OUTCOMES])
    figure = new_figure(7.0, 1.2 + 0.22 * len(counts))
    axes = figure.subplots()
    sums = np.array([np.sum(found, axis=0) for found in counts.values()])
    shares = 100 * sums / sums.sum(axis=1, keepdims=True)
    start = np.zeros(len(counts))
    for what, share, colour in zip(OUTCOMES, shares.T, COLOURS, strict=False):
        axes.barh(list(counts), share, left=start, color=colour, height=0.7, label=what)
        start += share
    axes.set(xlim=(0, 100), xlabel="files [%]", ylim=(len(counts) - 0.5, -0.5))
    figure.legend(loc="outside lower center", ncols=3)
    entitle(figure, title)
    return figure


def main(
    folder=RESULTS / "hostile_input",
    formats=tuple(SPECIMENS),
    most=MOST,
    cuts=CUTS,
    traps=TRAPS,
):
    """Write the table and the figure.

    Args:
        folder: Where the results go.
        formats: Readers whose specimens are damaged.
        most: Damages of one kind, other than cuts, to one file.
        cuts: Most cuts of one file.
        traps: Those to set.
    """
    record, rows = Record(folder, seed=0), []
    with Guard() as guard:
        makers = {name: SPECIMENS[name] for name in formats}
        makers |= {
            name: lambda folder, name=name: copy(DATA / name, folder)
            for name in MEASURED
            if formats == tuple(SPECIMENS) and (DATA / name).is_file()
        }
        for name, make in makers.items():
            with tempfile.TemporaryDirectory() as temporary:
                rows += mutants(guard, make(Path(temporary)), name, most, cuts)
        for trap in traps:
            with tempfile.TemporaryDirectory() as temporary:
                path = trap(Path(temporary))
                tally = Tally(file=trap.__name__.replace("_", " "), damage="trap")
                tally.add(guard.read(path), size_of(path), "specimen")
                rows.append(tally.counted())
    record.table(rows)
    record.figure(chart(rows, captions.hostile_input(record.folder)))
    record.close(
        damages_of_a_kind=most,
        cuts_of_a_file=cuts,
        files=sum(row["files"] for row in rows),
    )
    return rows


if __name__ == "__main__":
    sys.exit(int(any(row["wrong"] for row in main())))
