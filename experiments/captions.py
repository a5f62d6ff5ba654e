"""What experiments that leave only tables have found, worked out from their tables."""

import csv


def lines(folder, name="table"):
    """The lines of a table, with numbers as numbers."""
    with open(folder / f"{name}.csv", newline="", encoding="utf-8") as file:
        return [{k: number(v) for k, v in row.items()} for row in csv.DictReader(file)]


def number(text):
    """A number where the text is one."""
    try:
        return float(text)
    except ValueError:
        return text


def merl_ranking(folder):
    """The winner under the published residual."""
    first = lines(folder)[0]
    own = [r for r in lines(folder) if r["residual"] == first["residual"]]
    count = sum(row["best_on"] for row in own)
    return (
        f"Under the {first['residual']} residual {first['model']} is best on "
        f"{first['best_on']:.0f} of {count:.0f} materials."
    )


def curet_matte(folder):
    """The gain of the first rough model."""
    first = lines(folder, "gains")[0]
    return (
        f"{first['model']} leaves 1/{first['median_gain']:.2g} of lambert's error in "
        f"the median, between 1/{first['least_gain']:.2g} and "
        f"1/{first['largest_gain']:.2g}."
    )


def ptfe(folder):
    """The best model beside Lambert's."""
    rows = lines(folder)
    plain = next(row for row in rows if row["model"] == "lambert")
    return (
        f"{rows[0]['model']} leaves {rows[0]['relative_rms_percent']:.2g} % where "
        f"lambert leaves {plain['relative_rms_percent']:.2g} %."
    )


def ball_gloss(folder):
    """The first and the best of the models."""
    rows = [row for row in lines(folder) if not row["model"].startswith("(")]
    first, best = rows[0], min(rows, key=lambda row: row["image_error_percent"])
    return (
        f"{best['model']} leaves {best['image_error_percent']:.2g} % of the image, "
        f"{first['model']} {first['image_error_percent']:.2g} %."
    )


def hostile_input(folder):
    """How many files there were, and how many went wrong."""
    rows = lines(folder)
    wrong, count = (sum(row[key] for row in rows) for key in ("wrong", "files"))
    return f"{wrong:.0f} of {count:,.0f} damaged or lying files went wrong."


CAPTIONS = {
    caption.__name__: caption
    for caption in (merl_ranking, curet_matte, ptfe, ball_gloss, hostile_input)
}
