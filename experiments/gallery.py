"""The gallery: every experiment with its question, its answer and its figures.

    python -m experiments.gallery

It is made from what the experiments have left in `results`; nothing in it is typed.
"""

import re
import tomllib

import experiments
from brdffit.files import replacing
from experiments.record import RESULTS

PAGE = RESULTS / "README.md"
FIRST = "figure"  # which figure stands before the others
SHOWN = 6  # figures of one experiment, beyond which only the first is shown
FULL = "full"  # folder of the results at full size, where the usual one is reduced

HEAD = """# What the experiments found

Made by `python -m experiments`, which runs them all, from what each leaves in its
folder: tables, figures as PNG and PDF, and `run.toml` with versions, machine, seed and
commit. Each runs alone by `python -m experiments.NAME`.
"""


def questions():
    """What each experiment asks, in the order of the list in `experiments`."""
    lines = re.findall(r"^    (\w+)  +(\S.*\?)$", experiments.__doc__, re.MULTILINE)
    return dict(lines)


def figures(folder):
    """Names of its figures, the main one first; without the others if they are many."""
    found = sorted(path.name for path in folder.glob("*.png"))
    found.sort(key=lambda name: name != f"{FIRST}.png")
    return found if len(found) <= SHOWN else found[:1]


def section(name, question, root=RESULTS):
    """What one experiment contributes."""
    folder = root / name
    lines = [f"## {name}", "", question[0].upper() + question[1:]]
    if not (folder / "run.toml").exists():
        return [*lines, "", "It has not been run."]
    run = tomllib.loads((folder / "run.toml").read_text(encoding="utf-8"))
    finding = run.get("finding", "")
    if finding:
        lines += ["", f"**{finding}**"]
    for figure in figures(folder):
        lines += ["", f"![{question}]({name}/{figure})"]
    tables = [path.name for path in sorted(folder.glob("*.csv"))]
    links = [f"[{table}]({name}/{table})" for table in [*tables, "run.toml"]]
    if (folder / FULL).is_dir():
        links.append(f"[at full size]({name}/{FULL})")
    return [*lines, "", f"{', '.join(links)}; {run['seconds']:.0f} s"]


def page(root=RESULTS):
    """The whole page."""
    parts = [section(name, question, root) for name, question in questions().items()]
    return "\n\n".join([HEAD.strip(), *("\n".join(part) for part in parts)]) + "\n"


def main():
    """Write the page."""
    with replacing(PAGE) as temporary:
        temporary.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
