"""What does a fit of the bundled examples look like?

The measured paint that comes with the package, with the lobes of four models fitted to
it, and a simulated sphere under three lights with three models. These are the first
pictures of the README.
"""

import brdffit
from brdffit import plots
from brdffit.cli.demo import EXAMPLE
from brdffit.plots.style import entitle
from experiments.record import RESULTS, Record
from experiments.tradeoff import rounded

SPHERE = RESULTS.parent / "data_synthetic" / "cook_torrance_three_lights.exr"
PAINT = ("ggx+ggx_lobe", "ggx", "cook_torrance", "phong")
BALL = ("cook_torrance", "phong", "oren_nayar")
EXACT = 1e4  # times less error than the next: nothing but rounding is left


def rows_of(name, comparison):
    """Lines of one example."""
    return [
        {
            "example": name,
            "model": entry.result.model,
            "held_out": entry.held_out,
            "tied": entry.tied,
            "seconds": entry.result.seconds,
        }
        for entry in comparison.entries
    ]


def finding(rows):
    """How much better the winners are, as a sentence."""
    said = []
    for example in dict.fromkeys(row["example"] for row in rows):
        first, second = [row for row in rows if row["example"] == example][:2]
        ratio = second["held_out"] / first["held_out"]
        better = f"{rounded(ratio)} times better than {second['model']}"
        if ratio > EXACT:
            left = rounded(second["held_out"])
            better = f"exactly, where {second['model']} leaves an error of {left}"
        said.append(f"{first['model']} explains the {example} {better}")
    return "; ".join(said)


def entitled(figure, rows):
    """A figure of one example under what was found."""
    entitle(figure, f"{finding(rows)} ({figure.get_suptitle()})")
    return figure


def main(folder=RESULTS / "introduction", paint=PAINT, ball=BALL):
    """Write the table and both figures."""
    record = Record(folder)
    data = brdffit.load(EXAMPLE)
    lobes = brdffit.compare(data, paint)
    rows = rows_of("metallic paint", lobes)
    record.figure(entitled(plots.lobe_figure(data, lobes.results), rows), "lobes")
    data = brdffit.load(SPHERE)
    spheres = brdffit.compare(data, ball)
    seen = rows_of("simulated sphere", spheres)
    record.figure(
        entitled(plots.spheres_figure(data, spheres.results), seen), "spheres"
    )
    rows += seen
    record.table(rows)
    record.close(finding=finding(rows) + ".")


if __name__ == "__main__":
    main()
