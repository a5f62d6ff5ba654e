"""Write down what the oracle says of models that it takes minutes for.

    python -m tests.oracle.record

makes `ggx_multiscatter.json` anew; `tests/models/test_oracle.py` reads it, and checks
that it belongs to the present cases.
"""

import dataclasses
import json
from pathlib import Path

from tests.oracle import ORACLE
from tests.oracle.cases import cases
from tests.oracle.derivatives import Truth, truth

SLOW = ("ggx_multiscatter",)


def file(name):
    return Path(__file__).with_name(f"{name}.json")


def inputs(case):
    chosen, wi, wo = case
    return [{n: float(x) for n, x in chosen.items()}, wi.tolist(), wo.tolist()]


def record(name):
    lines = []
    for case in cases(name):
        found = dataclasses.asdict(truth(ORACLE[name], *case))
        lines.append(json.dumps({"case": inputs(case), "truth": found}))
        print(len(lines), flush=True)  # noqa: T201
    file(name).write_text("[\n" + ",\n".join(lines) + "\n]\n")


def recorded(name):
    """Truth for each of the cases of a model, as `record` wrote it."""
    entries = json.loads(file(name).read_text())
    if [entry["case"] for entry in entries] != [inputs(case) for case in cases(name)]:
        raise ValueError(
            f"`{file(name).name}` must hold the cases of `{name}`, but holds others: "
            "run `python -m tests.oracle.record`."
        )
    return [Truth(**entry["truth"]) for entry in entries]


if __name__ == "__main__":
    for name in SLOW:
        record(name)
