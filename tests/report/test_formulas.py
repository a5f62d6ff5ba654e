import pytest

from brdffit import MODELS
from brdffit.fit import RESIDUALS
from brdffit.parameters import parameters
from brdffit.report.formulas import as_html, printed


@pytest.mark.parametrize(
    ("label", "inside"),
    [
        (r"$f_r$", "<i>f</i><sub><i>r</i></sub>"),
        (r"$\alpha_x$", "α<sub><i>x</i></sub>"),
        (r"$\ln f_r$", "ln\N{THIN SPACE}<i>f</i><sub><i>r</i></sub>"),
        (r"$10^{-3}$", "10<sup>\N{MINUS SIGN}3</sup>"),
        (r"$30\degree$", "30°"),
        (r"$a < b$", "<i>a</i> &lt; <i>b</i>"),
    ],
)
def test_formula_is_html(label, inside):
    assert as_html(label) == f'<span class="formula">{inside}</span>'


def test_text_beside_a_formula_is_escaped():
    assert as_html("<b> & $x$ [1/sr]").startswith("&lt;b&gt; &amp; <span")


def test_every_label_and_symbol_of_the_package_is_understood():
    symbols = [
        p.symbol for model in MODELS.values() for p in parameters(model).values()
    ]
    labels = [residual.label for residual in RESIDUALS.values()]
    for label in [*labels, *(f"${symbol}$" for symbol in symbols)]:
        assert not set(as_html(label)) & set("\\$_{}^"), label


@pytest.mark.parametrize(
    ("number", "shown"),
    [
        ("0.5", "0.5"),
        ("-0.25", "\N{MINUS SIGN}0.25"),
        ("1.2e-08", "1.2\N{THIN SPACE}·\N{THIN SPACE}10⁻⁸"),
        ("inf", "inf"),
    ],
)
def test_numbers_are_printed_with_their_sign_and_power(number, shown):
    assert printed(number) == shown
