from brdffit import MODELS
from brdffit.plots import ranking_figure
from tests.results import comparison_of

MODEL_NAMES = ("ggx", "phong", "lambert")


def figure_of(**options):
    return ranking_figure(comparison_of(*(MODELS[n]() for n in MODEL_NAMES), **options))


def test_bars_are_held_out_errors_with_the_best_on_top():
    bars, _ = figure_of(tied=(0,)).axes
    widths = [round(bar.get_width(), 6) for bar in bars.patches]
    assert widths == [0.1, 0.2, 0.3]
    assert [label.get_text() for label in bars.get_yticklabels()] == list(MODEL_NAMES)
    bottom, top = bars.get_ylim()
    assert bottom > top  # the axis points down
    assert bars.get_xlabel() == r"root mean square error of $\ln f_r$"


def test_ties_are_told_by_word_and_by_hatching():
    bars, _ = figure_of(tied=(0, 1)).axes
    names = [label.get_text() for label in bars.get_yticklabels()]
    assert names == ["ggx (tied)", "phong (tied)", "lambert"]
    hatched = [bool(bar.get_hatch()) for bar in bars.patches]
    assert hatched == [True, True, False]


def test_a_winner_without_a_tie_is_not_called_tied():
    bars, _ = figure_of(tied=(0,)).axes
    assert not any(bar.get_hatch() for bar in bars.patches)


def test_table_holds_the_numbers():
    _, table = figure_of().axes
    words = [text.get_text() for text in table.texts]
    assert {"0.1000", "0.2000", "0.1250", "0.0", "7", "3"} <= set(words)


def test_title_says_what_is_ranked_by():
    assert "error on 20 held-out directions" in figure_of().get_suptitle()
