"""The rules of the house, checked: layers, registry, numerics, docstrings."""

import ast
import re
from pathlib import Path

import pytest

import brdffit
from brdffit import MODELS, AbstractBRDF

ROOT = Path(brdffit.__file__).parent
TESTS = Path(__file__).parent
FILES = sorted(ROOT.rglob("*.py"))

# functions with an infinite derivative somewhere, and modules of them
SINGULAR = {"sqrt", "arccos", "arcsin", "arctan2", "cbrt", "hypot", "linalg"}
SINGULAR |= {"acos", "asin", "atan2", "pow", "power", "float_power"}
NAMELESS = {"common", "core", "helpers", "misc", "tools", "utils"}
LONGEST = 275  # lines; past 250 a file is usually two ideas

every_file = pytest.mark.parametrize(
    "path", FILES, ids=[str(path.relative_to(ROOT)) for path in FILES]
)
every_model = pytest.mark.parametrize("name", MODELS)


def layers():
    """Level of each unit in the map that the package's docstring draws, from above."""
    lines = re.findall(r"^    (\w+(?:, \w+)*)  ", brdffit.__doc__, re.MULTILINE)
    return {name: i for i, line in enumerate(lines) for name in line.split(", ")}


def unit(path):
    """The first name below the package: the folder or module a file belongs to."""
    return path.relative_to(ROOT).with_suffix("").parts[0]


def imported(path):
    """Units of the package that a file imports; the empty string is the package."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module == "brdffit":
            modules = [f"brdffit.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            modules = [node.module]
        else:
            continue
        for module in modules:
            package, _, rest = module.partition(".")
            if package == "brdffit":
                yield rest.partition(".")[0]


def test_every_unit_has_its_line_in_the_map():
    units = {unit(path) for path in FILES} - {"__init__", "__main__"}
    assert units == set(layers()), "the docstring of brdffit/__init__.py is the map"


@every_file
def test_imports_point_up_the_map(path):
    own = unit(path)
    if own in {"__init__", "__main__"}:
        return
    for target in set(imported(path)) - {own}:
        if not target:
            assert own == "cli", "only the command line imports the public names"
            continue
        assert layers()[target] < layers()[own], f"{own} imports {target}"


@every_file
def test_singular_functions_live_in_numerics(path):
    used = {
        node.attr
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "jnp"
    }
    assert path.name == "numerics.py" or not used & SINGULAR, "use brdffit.numerics"


@every_file
def test_file_is_one_idea_under_a_name_that_says_which(path):
    assert len(path.read_text().splitlines()) <= LONGEST
    parts = path.relative_to(ROOT).with_suffix("").parts
    assert len(parts) <= 2, "folders nest once"
    assert not NAMELESS & set(parts)
    assert not any(p.startswith("_") and not p.startswith("__") for p in parts)


def test_every_model_file_is_registered():
    files = {path.stem for path in (ROOT / "models").glob("*.py")}
    assert files - {"__init__", "base"} == set(MODELS), "add it to models/__init__.py"
    found = [m.__module__ for m in AbstractBRDF.__subclasses__()]
    models = [module for module in found if module.startswith("brdffit.models.")]
    assert len(MODELS) == len(models), "one model per file"


@every_model
def test_model_and_file_share_their_name(name):
    assert MODELS[name].__name__.lower() == name.replace("_", "")


@every_model
def test_model_docstring_has_formula_range_and_source(name):
    for part in ("$$f_r", "Range:", "Source:"):
        assert part in MODELS[name].__doc__, f"{name} lacks {part!r}"


def test_every_folder_of_the_package_has_its_folder_of_tests():
    folders = {path.parent.name for path in FILES if path.parent != ROOT}
    assert folders <= {path.name for path in TESTS.iterdir() if path.is_dir()}
