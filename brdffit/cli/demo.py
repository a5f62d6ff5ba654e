"""``brdffit demo``: the main job, from a measurement to results and pictures."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli.compare import compare
from brdffit.cli.options import Json

EXAMPLE = Path(brdffit.__path__[0]) / "example" / "metallic_paint.csv"
MODELS = "lambert,phong,cook_torrance,ggx,ggx+ggx_lobe"


def demo(
    *,
    out: Annotated[Path, Parameter("--out")] = Path("brdffit-demo"),
    as_json: Json = False,
) -> int:
    """Compare models on the bundled example; write results, pictures and a report.

    Takes less than a minute and opens nothing.

    Args:
        out: Folder for results, pictures and report.html. [brdffit-demo]
    """
    return compare(EXAMPLE, models=MODELS, out=out, report=True, as_json=as_json)
