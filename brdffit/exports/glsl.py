"""GLSL: a function ``vec3 brdf(vec3 wi, vec3 wo)``, for any model.

The function is the model's own formula with its parameters as constants. It needs GLSL
1.30 or later and nothing else; directions are in the shading frame, where the normal is
the z axis, and what it returns is f_r in 1/sr without the cosine.
"""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from brdffit.catalogue import description
from brdffit.exports.material import Material, in_rgb
from brdffit.exports.program import ARITHMETIC, Node, Program, literal
from brdffit.exports.transcription import transcribe
from brdffit.files import replacing
from brdffit.models import AbstractBRDF

DESCRIPTION = "GLSL function with the formula of the model"
SUFFIX = ".glsl"
LONGEST = 70  # characters of an expression that is written where it is used

ADDED = {
    "log1p": """\
float log1p(float x)
{
    return abs(x) < 1e-2 ? x * (1.0 - x * (0.5 - x * (1.0 / 3.0 - x * 0.25)))
                         : log(1.0 + x);
}
""",
    # Abramowitz and Stegun 7.1.26; below 0.3 the series, which keeps relative accuracy
    "erf": """\
float erf(float x)
{
    float a = abs(x), s = x * x, t = 1.0 / (1.0 + 0.3275911 * a);
    float series = 1.1283792 * x * (1.0 - s * (1.0 / 3.0 - s * (0.1 - s / 42.0)));
    float tail = ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t
                   - 0.284496736) * t + 0.254829592) * t * exp(-s);
    return a < 0.3 ? series : sign(x) * (1.0 - tail);
}
""",
}


def translate(brdf: AbstractBRDF, channels: Sequence[str] = ()) -> Material:
    """Write a BRDF out as GLSL.

    Raises:
        ValueError: It has more channels than colours, or an operation beyond GLSL.
    """
    program = transcribe(in_rgb(brdf, "GLSL", channels))
    text = source(program, description(brdf))

    def write(path: Path) -> None:
        with replacing(path) as temporary:
            temporary.write_text(text)

    return Material(
        evaluate=program,
        write=write,
        parameters={"statements": len(program.statements)},
        evaluator="the written statements, carried out in single precision",
    )


def source(program: Program, told: dict[str, Any]) -> str:
    """The text of the function."""
    used = {operation for operation, _ in program.statements}
    parts = [ADDED[name] for name in ADDED if name in used]
    about = [
        "f_r in 1/sr without the cosine; 0 at and below the horizon.",
        "wi points to the light, wo to the viewer; the normal is (0, 0, 1).",
        json.dumps(told),
    ]
    comment = "".join(f"// {line}\n" for line in about)
    body = "\n".join(f"    {line}" for line in statements(program))
    return "\n".join(
        [*parts, f"{comment}vec3 brdf(vec3 wi, vec3 wo)\n{{\n{body}\n}}\n"]
    )


def statements(program: Program) -> Iterator[str]:
    """One line for each number that is used more than once or is long."""
    uses = [0] * len(program.statements)
    for _, operands in program.statements:
        for x in operands:
            if isinstance(x, Node):
                uses[x.place] += 1
    results = [x for x in program.results if isinstance(x, Node)]
    for x in results:
        uses[x.place] += 1
    needed = reached(program, results)
    texts: dict[int, str] = {}

    def text(x: Any) -> str:
        return texts[x.place] if isinstance(x, Node) else literal(x)

    for place, (operation, operands) in enumerate(program.statements):
        if operation == "input":
            texts[place] = operands[0]
        elif place in needed:
            made = ARITHMETIC[operation].format(*map(text, operands))
            if uses[place] == 1 and len(made) <= LONGEST:
                texts[place] = made
            else:
                texts[place] = f"x{place}"
                kind = "bool" if program.logical[place] else "float"
                yield f"{kind} x{place} = {without_brackets(made)};"
    channels = ", ".join(without_brackets(text(x)) for x in program.results)
    yield f"return vec3({channels});"


def reached(program: Program, results: Sequence[Node]) -> set[int]:
    """Places of the statements that the results depend on."""
    found: set[int] = set()
    left = [x.place for x in results]
    while left:
        place = left.pop()
        if place not in found:
            found.add(place)
            _, operands = program.statements[place]
            left += [x.place for x in operands if isinstance(x, Node)]
    return found


def without_brackets(text: str) -> str:
    """An expression without the pair of brackets around all of it."""
    depth = 0
    for place, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if depth == 0 and place < len(text) - 1:
            return text
    return text[1:-1] if text.startswith("(") else text
