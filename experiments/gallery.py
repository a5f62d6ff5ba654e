"""The gallery: every experiment with its question, its answer and its figures.

    python -m experiments.gallery

It is made from what the experiments have left in `results`, and so are the pictures and
the table of models in the README; nothing in them is typed.
"""

import inspect
import re
import tomllib

import experiments
from brdffit.files import replacing
from brdffit.models import MODELS
from brdffit.parameters import parameters
from experiments.captions import CAPTIONS
from experiments.record import RESULTS

PAGE = RESULTS / "README.md"
README = RESULTS.parent / "README.md"
INTRODUCTION = {"introduction": ("lobes", "spheres")}
PICTURES = {
    "solvers": ("figure",),
    "six_materials": ("figure",),
    "effect_cost": ("pictures",),
    "model_comparison": ("figure",),
}
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


def timed():
    """Names of the experiments whose answer is a time, those of the first part."""
    first = experiments.__doc__.split(":\n\n")[1].partition("\n\n")[0]
    return re.findall(r"^    (\w+)", first, re.MULTILINE)


def figures(folder):
    """Names of its figures, the main one first; without the others if they are many."""
    found = sorted(path.name for path in folder.glob("*.png"))
    found.sort(key=lambda name: name != f"{FIRST}.png")
    return found if len(found) <= SHOWN else found[:1]


def told(folder):
    """What a run says of itself; nothing where there was none."""
    path = folder / "run.toml"
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def section(name, question, root=RESULTS):
    """What one experiment contributes."""
    folder = root / name
    lines = [f"## {name}", "", question[0].upper() + question[1:]]
    run = told(folder)
    if not run:
        return [*lines, "", "It has not been run."]
    finding = run.get("finding", "")
    if not finding and name in CAPTIONS:
        finding = CAPTIONS[name](folder)
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


def models():
    """Table of the models, each with a sphere, for the README."""
    lines = ["| | model | what it is | parameters |", "| --- | --- | --- | --- |"]
    for name, model in MODELS.items():
        picture = RESULTS / "catalogue" / f"{name}.png"
        if not picture.exists():
            continue
        words = inspect.getdoc(model).partition("\n")[0].rstrip(".")
        shown = f'<img src="results/catalogue/{name}.png" alt="sphere of {name}">'
        known = ", ".join(f"`{p}`" for p in parameters(model()))
        lines.append(f"| {shown} | `{name}` | {words} | {known} |")
    return lines


def headline(chosen):
    """Pictures for the README, and what each experiment found; none that is absent."""
    lines = []
    for name, names in chosen.items():
        question, run = questions()[name], told(RESULTS / name)
        found = [n for n in names if f"{n}.png" in run.get("sha256", ())]
        for figure in found:
            words = question[0].upper() + question[1:]
            lines += [f"![{words}](results/{name}/{figure}.png)", ""]
        if found:
            lines += [run.get("finding", ""), ""]
    return lines[:-1]


def filled(text):
    """The README with its parts that are made here."""
    parts = {
        "introduction": headline(INTRODUCTION),
        "pictures": headline(PICTURES),
        "models": models(),
    }
    for name, lines in parts.items():
        part = "\n".join([f"<!-- {name} -->", *lines, f"<!-- end of {name} -->"])
        pattern = f"<!-- {name} -->.*?<!-- end of {name} -->"
        text = re.sub(pattern, lambda _, part=part: part, text, flags=re.DOTALL)
    return text


def main():
    """Write the gallery, and what the README shows of it."""
    readme = README.read_text(encoding="utf-8")
    for path, text in ((PAGE, page()), (README, filled(readme))):
        with replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
