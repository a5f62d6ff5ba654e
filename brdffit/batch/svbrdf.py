"""From photographs of a surface to its maps: read, fit every texel, draw, predict.

A run leaves in its folder

- ``stack.zarr``, the texels of the photographs, when these were given;
- ``fit``, what `brdffit.fit_texture` writes;
- ``maps/NAME.exr`` for every parameter, ``maps/NAME_error.exr`` for its standard error,
  and ``rms``, ``converged``, ``at_bound`` and ``steps`` in the same place; NaN where
  there is no texel;
- ``maps.png`` and ``.pdf``, a sheet of all of them;
- ``held_out.exr``, ``.png`` and ``.pdf``, what the maps show under the light of the
  photograph that was held out, and how that differs, when one was;
- ``summary.json``, what of all this can be said in numbers.
"""

import dataclasses
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from brdffit import images
from brdffit.batch.maps import Layout, maps, numbers
from brdffit.batch.relighting import held_out, relative_errors, relit
from brdffit.batch.stack import import_zarr
from brdffit.batch.surface import Surface, open_surface
from brdffit.batch.tally import Tally
from brdffit.batch.texture import FITS, fit_texture
from brdffit.catalogue import from_name
from brdffit.files import replacing
from brdffit.fit.conditions import Numbers
from brdffit.models.base import AbstractBRDF
from brdffit.parameters import parameters, registry_name
from brdffit.plots import maps_figure, relit_figure, save
from brdffit.plots.maps import PIXELS, window

STACK, FIT, MAPS, SUMMARY = "stack.zarr", "fit", "maps", "summary.json"
HELD_OUT = "held_out"


@dataclasses.dataclass(frozen=True)
class Svbrdf:
    """A fitted surface.

    Attributes:
        summary: Its numbers, as in ``summary.json``.
        tally: How many texels were kept, done, and did not converge.
        maps: Images of each parameter, its error and the end of the fit.
        files: What else there is to look at, the sheet of all maps first.
    """

    summary: dict[str, Any]
    tally: Tally
    maps: list[Path]
    files: list[Path]


def svbrdf(
    model: str,
    source: str | Path,
    out: str | Path,
    *,
    hold_out: str | None = None,
    residual: str | None = None,
    fixed: Mapping[str, Numbers] | None = None,
    resume: bool = False,
    cluster: str | None = None,
    on_progress: Callable[[Tally], None] | None = None,
) -> Svbrdf:
    """Fit a model to every texel of a surface and write its maps.

    Args:
        model: Name of a model or sum.
        source: Folder of photographs, as `brdffit.readers.capture` describes, or a zarr
            group of texels, as `brdffit.batch.stack` does.
        out: Folder of the run.
        hold_out: Name or number of a photograph not to fit but to predict.
        residual: What is compared; by default the difference of radiances.
        fixed: Parameters to hold in all texels, with their values.
        resume: Go on with what an earlier run has left.
        cluster: Address of a Dask scheduler; by default threads of this process.
        on_progress: Called with the tally of the fit as it grows.

    Raises:
        ValueError: There is no such model or photograph, or the source is wrong.
        FileExistsError: The folder holds an earlier run that is not to be resumed.
        OSError: Something cannot be read or written.
    """
    from_name(model)
    source, out = Path(source), Path(out)
    if not resume and (out / FIT).exists():
        raise FileExistsError(
            f"Folder `{out}` holds an earlier run: go on with it by --resume (in "
            "Python, resume=True), or name another folder."
        )
    surface = open_surface(source, out / STACK, hold_out)
    brdf = from_name(model, len(surface.channels))
    fitted, other, count = surface.stack, None, len(surface.photographs)
    if surface.held_out is not None:
        fitted, other = held_out(fitted, count, surface.held_out)
        count -= 1
    tally = fit_texture(
        model,
        fitted,
        out / FIT,
        residual=residual,
        fixed=fixed,
        resume=resume,
        cluster=cluster,
        on_progress=on_progress,
    )
    results = import_zarr().open_group(out / FIT / FITS, mode="r")

    summary = _numbers(results, brdf, surface, count)
    title = f"{surface.name}: {model} fitted to {count} photographs"
    written, figure = _write_maps(results, brdf, surface.layout, out, title)
    files = save(figure, out, MAPS)
    if surface.held_out is not None and other is not None:
        photograph = surface.photographs[surface.held_out]
        seen, predicted = relit(brdf, results, other, surface.layout)
        whole, *each = relative_errors(seen, predicted)
        summary[HELD_OUT] = {
            "photograph": photograph,
            "relative_rms": whole,
            "relative_rms_of_channels": each,
            "texels": int(np.isfinite(seen).any(axis=-1).sum()),
        }
        title = (
            f"{surface.name}: {photograph} predicted by {model}, relative root mean "
            f"square of the difference {100 * whole:.2f} %"
        )
        images.write(out / f"{HELD_OUT}.exr", predicted, surface.channels)
        figure = relit_figure(seen, predicted, title)
        files += [*save(figure, out, HELD_OUT), out / f"{HELD_OUT}.exr"]
    with replacing(out / SUMMARY) as temporary:
        temporary.write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n")
    return Svbrdf(summary, tally, written, [*files, out / SUMMARY])


def _write_maps(
    results: Any, brdf: AbstractBRDF, layout: Layout, out: Path, name: str
) -> tuple[list[Path], Figure]:
    """Every map as an EXR, and a sheet of them all."""
    (out / MAPS).mkdir(exist_ok=True)
    written, small = [], {}
    where = window(layout.image(np.zeros((1, len(layout.pixel)))), PIXELS)
    for title, image in maps(results, layout):
        images.write(out / MAPS / f"{title}.exr", image)
        written.append(out / MAPS / f"{title}.exr")
        small[title] = image[where].copy()
    return written, maps_figure(brdf, small, name)


def _numbers(
    results: Any, brdf: AbstractBRDF, surface: Surface, observations: int
) -> dict[str, Any]:
    """What can be said of a fit in numbers; medians are over the texels."""
    rms = numbers(results, "rms")
    return {
        "name": surface.name,
        "model": registry_name(brdf),
        "texels": len(rms),
        "channels": list(surface.channels),
        "observations": observations,
        "converged": float(numbers(results, "converged").mean()),
        "at_bound": float(numbers(results, "at_bound").mean()),
        "median_rms": float(np.median(rms)),
        "parameters": {
            key: {
                "median": _medians(numbers(results, f"parameters/{key}")),
                "standard_error": _medians(numbers(results, f"standard_errors/{key}")),
            }
            for key in parameters(brdf)
        },
    }


def _medians(values: np.ndarray) -> list[float | None]:
    """Of each channel; None where most texels cannot tell."""
    found = np.median(values, axis=-1)
    return [float(x) if np.isfinite(x) else None for x in found]
