"""From a fit or a comparison to one HTML file."""

import re
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from brdffit.files import replacing
from brdffit.fit import FitResult
from brdffit.fit.appearance import ColourDifference, sphere_difference
from brdffit.fit.select import Comparison
from brdffit.report.details import (
    Correlation,
    Error,
    Number,
    correlation,
    errors_by_residual,
    numbers,
)
from brdffit.report.facts import facts_of_data, facts_of_making
from brdffit.report.formulas import as_html, printed
from brdffit.report.lobes import lobe_table
from brdffit.report.maps import residual_maps
from brdffit.report.ranking import ranking
from brdffit.report.spheres import scale_of_colours, sphere_album
from brdffit.report.verdict import unsure, verdict_on_comparison, verdict_on_fit
from brdffit.report.yardstick import yardstick
from brdffit.samples import Measurement, Samples, as_samples
from brdffit.survey.reciprocity import Evaluate

MODELS = 6  # most models that are shown in pictures


class Detail(NamedTuple):
    """What the page says of one model."""

    name: str
    result: FitResult
    numbers: list[Number]
    doubts: list[str]
    correlation: Correlation
    errors: list[Error]
    colour: ColourDifference | None


def report(
    outcome: FitResult | Comparison,
    data: Measurement | Samples,
    path: Path | str,
    *,
    source: Path | str | None = None,
    evaluate: Evaluate | None = None,
) -> Path:
    """Write the report of a fit or a comparison as one HTML file.

    The file needs no network and nothing beside it; it can be printed.

    Args:
        outcome: What `fit` or `compare` returned.
        data: What was fitted.
        path: Where to write.
        source: File or folder that the data were read from, which the report names.
        evaluate: ``f_r (N, C)`` of the measured material for directions ``wi, wo (N,
            3)``, where that is known: then a sphere of the material is shown.

    Returns:
        The path.

    Raises:
        ValueError: A fit under a residual that is not in `RESIDUALS`.
        OSError: The file cannot be written, or the source not be read.
    """
    path = Path(path)
    content = page(outcome, data, Path(source) if source else None, evaluate)
    with replacing(path) as temporary:
        temporary.write_text(content, encoding="utf-8")
    return path


def page(
    outcome: FitResult | Comparison,
    data: Measurement | Samples,
    source: Path | None = None,
    evaluate: Evaluate | None = None,
) -> str:
    """The HTML of `report`."""
    single = isinstance(outcome, FitResult)
    results = {outcome.model: outcome} if single else outcome.results
    shown = dict(list(results.items())[:MODELS])
    models = {name: result.brdf for name, result in shown.items()}
    samples = as_samples(data)
    best = next(iter(shown.values()))
    unit = "directions" if samples.pixels is None else "pixels"
    measure = yardstick(best.residual, samples)
    if single:
        verdict = verdict_on_fit(outcome, measure)
        colours = {outcome.model: sphere_difference(outcome.brdf, data)}
    else:
        verdict = verdict_on_comparison(outcome, measure, unit)
        entries = zip(results, outcome.entries, strict=True)
        colours = {name: entry.colour for name, entry in entries}
    details = [
        Detail(
            name,
            result,
            numbers(result),
            unsure(result),
            correlation(result),
            errors_by_residual(result),
            colours[name],
        )
        for name, result in shown.items()
    ]
    spheres = sphere_album(data, models, evaluate)
    return (
        environment()
        .get_template("page.html")
        .render(
            title=best.data,
            unit=unit,
            best=best,
            quantity=as_html(measure.residual.label),
            yardstick=measure,
            verdict=verdict,
            comparison=None if single else outcome,
            ranking=[] if single else ranking(outcome, measure),
            details=details,
            count=len(results),
            spheres=spheres,
            colours=scale_of_colours(),
            lobes=lobe_table(data, models),
            maps=residual_maps(samples, models, measure.residual),
            data_facts=facts_of_data(data, source, evaluate),
            making=facts_of_making(),
            source=source,
        )
    )


def environment() -> Environment:
    """The templates; every string that they are given is escaped."""
    templates = Environment(
        loader=PackageLoader("brdffit.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters |= {"code": code, "breakable": breakable, "printed": printed}
    templates.policies["json.dumps_kwargs"] = {"sort_keys": False}
    return templates


def code(sentence: str, broken: bool = False) -> Markup:
    """A sentence in which words between backticks are code, ``broken`` if need be."""
    parts = sentence.split("`")
    words = [breakable(part) if broken else escape(part) for part in parts[1::2]]
    marked: list[Markup] = [escape(part) for part in parts]
    marked[1::2] = [Markup("<code>{}</code>").format(word) for word in words]
    return Markup("").join(marked)


def breakable(name: str) -> Markup:
    """A name that may go on in the next line after an underscore or a plus."""
    return Markup(re.sub(r"([_+])", r"\1<wbr>", str(escape(name))))
