import dataclasses
import math

from brdffit import MODELS
from brdffit.cli.console import output
from brdffit.cli.tables import parameter_table, ranking_table, side_by_side
from tests.results import comparison_of, result_of


def text_of(table, width=200):
    console = output()
    console.width = width
    with console.capture() as captured:
        console.print(table)
    return captured.get()


def test_table_tells_bounds_units_and_doubts():
    brdf = MODELS["oren_nayar"](albedo=[0.5, 1.0], sigma=0.0)
    result = result_of(
        brdf,
        at_bound={"albedo[1]": "`albedo[1]` is at its upper bound 1."},
        undetermined={"sigma": "`sigma` has no effect on these data."},
    )
    result.standard_errors["sigma"] = math.inf
    lines = [line.split() for line in text_of(parameter_table(result)).splitlines()]
    assert lines[1] == ["albedo[0]", "a", "0.500", "0.010", "[0,", "1]"]
    assert lines[2] == ["albedo[1]", "b", "1.000", "0.010", "[0,", "1]", "at", "bound"]
    assert lines[3][:4] == ["sigma", "0", "undetermined", "rad"]


def test_a_single_channel_is_not_named():
    result = result_of(MODELS["lambert"](albedo=[0.5]))
    assert "650nm" not in text_of(parameter_table(result))


def test_models_stand_side_by_side_with_a_row_for_each_parameter():
    comparison = comparison_of(MODELS["ggx"](), MODELS["lambert"](albedo=[0.25] * 3))
    (table,) = side_by_side(comparison, output())
    lines = text_of(table).splitlines()
    assert lines[0].split() == ["parameter", "ggx", "lambert"]
    rows = {line.split()[0]: line for line in lines[1:]}
    assert "0.300 \N{PLUS-MINUS SIGN} 0.010" in rows["alpha"]
    assert rows["albedo[0]"].count("\N{PLUS-MINUS SIGN}") == 1
    assert rows["albedo[0]"].index("0.250") >= lines[0].index("lambert")


def test_a_narrow_terminal_gets_several_tables():
    comparison = comparison_of(*(MODELS[name]() for name in ("ggx", "phong", "ward")))
    console = output()
    console.width = 50
    tables = list(side_by_side(comparison, console))
    assert len(tables) > 1
    shown = "".join(text_of(table, 50) for table in tables)
    assert all(name in shown for name in ("ggx", "phong", "ward"))
    assert max(len(line) for line in shown.splitlines()) <= 50


def test_ranking_flags_ties_and_breaks_no_number():
    models = (MODELS["ggx"](), MODELS["blinn_phong_original"](), MODELS["phong"]())
    text = text_of(ranking_table(comparison_of(*models, tied=(0, 1))), width=80)
    first, second, third = (line.split() for line in text.splitlines()[-3:])
    assert first[:4] == ["1", "ggx", "tied", "0.1000"]
    assert second[:4] == ["2", "blinn_phong_original", "tied", "0.2000"]
    assert third[:3] == ["3", "phong", "0.3000"]
    alone = text_of(ranking_table(comparison_of(*models, tied=(0,))))
    assert "tied" not in alone


def test_chi_square_is_told_where_errors_are_known():
    comparison = comparison_of(MODELS["ggx"]())
    assert "chi-square" not in text_of(ranking_table(comparison))
    known = dataclasses.replace(comparison.best, chi_square=250.0)
    entry = dataclasses.replace(comparison.entries[0], result=known)
    text = text_of(ranking_table(dataclasses.replace(comparison, entries=(entry,))))
    assert "chi-square" in text
    assert "2.500" in text  # for 100 values
