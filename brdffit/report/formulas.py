"""Formulas and numbers as they are printed.

Of LaTeX that part is understood which axes and parameters use.
"""

import re

from markupsafe import Markup, escape

SYMBOLS = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "eta": "η",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "theta": "θ",
    "phi": "φ",
    "omega": "ω",
    "lambda": "λ",
    "cos": "cos\N{THIN SPACE}",
    "ln": "ln\N{THIN SPACE}",
    "degree": "°",
    "pm": "±",
    "cdot": "·",
    ",": "\N{THIN SPACE}",
}
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
RAISED = r"[_^](?:\{[^}]*\}|\\[a-zA-Z]+|.)"
TOKEN = re.compile(rf"{RAISED}|\\[a-zA-Z]+|\\.|.", re.DOTALL)


def as_html(label: str) -> Markup:
    """A label as HTML; what stands between dollars is a formula, the rest is text."""
    parts = label.split("$")
    return Markup("").join(
        Markup('<span class="formula">{}</span>').format(formula(part))
        if place % 2
        else escape(part)
        for place, part in enumerate(parts)
        if part
    )


def formula(tex: str) -> Markup:
    """One formula as HTML: letters slanted, indices and exponents in their place."""
    parts = Markup("").join(map(_token, TOKEN.findall(tex)))
    return parts.replace("\N{THIN SPACE} ", "\N{THIN SPACE}")


def _token(token: str) -> Markup:
    if token[0] in "_^" and len(token) > 1:
        inside = formula(token[1:].removeprefix("{").removesuffix("}"))
        element = Markup("<sub>{}</sub>" if token[0] == "_" else "<sup>{}</sup>")
        return element.format(inside)
    if token[0] == "\\":
        return escape(SYMBOLS.get(token[1:], token[1:]))
    if token.isalpha():
        return Markup("<i>{}</i>").format(token)
    return escape(token.replace("-", "\N{MINUS SIGN}"))


def printed(number: str) -> str:
    """A number with a true minus sign, and powers of ten written out."""
    mantissa, exponent, power = number.partition("e")
    if exponent:
        raised = str(int(power)).translate(SUPERSCRIPT)
        mantissa = f"{mantissa}\N{THIN SPACE}·\N{THIN SPACE}10{raised}"
    return mantissa.replace("-", "\N{MINUS SIGN}")
