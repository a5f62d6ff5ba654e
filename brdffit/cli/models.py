"""``brdffit models``: the catalogue, and one model in full."""

import inspect
import re
from typing import Any

import brdffit
from brdffit.cli import console
from brdffit.cli.options import Json


def models(name: str | None = None, /, *, as_json: Json = False) -> None:
    """List all models, or describe one: parameters, properties, formula and source.

    Args:
        name: Name of a model.
    """
    from brdffit.names import look_up

    if name is None:
        facts = [describe(model) for model in brdffit.MODELS.values()]
        console.print_json({"models": facts}) if as_json else print_catalogue(facts)
    else:
        facts = describe(look_up(brdffit.MODELS, name, "Model"))
        console.print_json(facts) if as_json else print_model(facts)


def describe(model: "type[brdffit.AbstractBRDF]") -> dict[str, Any]:
    """What is known about a model: its declarations and its docstring in parts."""
    from brdffit.parameters import parameters, registry_name

    text = inspect.cleandoc(model.__doc__ or "")
    return {
        "name": registry_name(model),
        "summary": text.partition("\n")[0],
        "reciprocal": model.reciprocal,
        "energy_conserving": model.energy_conserving,
        "isotropic": model.isotropic,
        "parameters": {
            name: {
                "bounds": [known.lower, known.upper],
                "typical": list(known.typical),
                "unit": known.unit,
                "symbol": known.symbol,
                "per_channel": known.spectral,
                "linear": known.linear,
            }
            for name, known in parameters(model()).items()
        },
        "formula": re.findall(r"\$\$(.+?)\$\$", text, flags=re.DOTALL),
        "description": text,
    }


def print_catalogue(catalogue: list[dict[str, Any]]) -> None:
    """One line for each model."""
    from brdffit.cli.tables import new_table

    table = new_table(
        "name", "parameters", "reciprocal", "energy conserving", "what it is"
    )
    for facts in catalogue:
        table.add_row(
            facts["name"],
            ", ".join(facts["parameters"]),
            yes_no(facts["reciprocal"]),
            yes_no(facts["energy_conserving"]),
            facts["summary"],
        )
    console.output().print(table)


def print_model(facts: dict[str, Any]) -> None:
    """Everything about one model."""
    from brdffit.cli.tables import new_table

    out = console.output()
    out.print(f"{facts['name']}: {facts['description']}")
    out.print()
    table = new_table("parameter", "range", "typical", "unit", "symbol", "channels")
    for name, known in facts["parameters"].items():
        table.add_row(
            name,
            "[{:g}, {:g}]".format(*known["bounds"]),
            "[{:g}, {:g}]".format(*known["typical"]),
            known["unit"],
            known["symbol"],
            "one value each" if known["per_channel"] else "one value in all",
        )
    out.print(table)
    out.print()
    out.print(
        f"Reciprocal: {yes_no(facts['reciprocal'])}. "
        f"Energy conserving: {yes_no(facts['energy_conserving'])}. "
        f"Isotropic: {yes_no(facts['isotropic'])}."
    )


def yes_no(fact: bool) -> str:
    """A fact in a word."""
    return "yes" if fact else "no"
