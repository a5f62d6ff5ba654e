"""``brdffit simulate``: a measurement that was never made, of a known material."""

import dataclasses
import json
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import brdffit
from brdffit.cli import console
from brdffit.cli.options import (
    Json,
    Lights,
    Resolution,
    SceneFile,
    Settings,
    assignments,
    numbers,
    refuse,
    words,
)

TABLE, IMAGE = ".csv", ".exr"
THETA_I = "10,30,50,70"
THETA_O = ",".join(str(angle) for angle in range(0, 86, 5))
PHI = "0,30,60,90,120,135,150,165,180"


def simulate(
    *,
    model: str,
    settings: Settings = (),
    out: Annotated[Path, Parameter("--out")],
    noise: float = 0.0,
    additive: float = 0.0,
    seed: int = 0,
    channels: str | None = None,
    theta_i: str | None = None,
    theta_o: str | None = None,
    phi: str | None = None,
    scene: SceneFile = None,
    lights: Lights = None,
    resolution: Resolution = None,
    as_json: Json = False,
) -> None:
    """Write what a goniometer (.csv) or a camera (.exr) would see of a known material.

    The header of a table says the truth; so does the .toml beside an image, which holds
    its scene. A preview (.png) stands there too.

    Args:
        model: Name of a model or sum, or file of a saved result.
        out: File to write, a table .csv or an image .exr.
        noise: Standard deviation of the noise, relative to each value. [0]
        additive: Standard deviation of further noise, in the unit of the values. [0]
        seed: Seed of the noise. [0]
        channels: Names of the channels with commas between them. [R,G,B]
        theta_i: Polar angles of the light in degrees, for a table. [10,30,50,70]
        theta_o: Polar angles of the viewer in degrees, for a table. [0,5, .. 85]
        phi: Azimuths of the viewer in degrees; mirror directions are at 180.
    """
    from brdffit.cli.inputs import saved_or_named, scene_or_sphere
    from brdffit.files import require_writable
    from brdffit.render import provenance
    from brdffit.writers import sphere, table

    kind = out.suffix.lower()
    if kind == IMAGE:
        refuse(out, {"--theta-i": theta_i, "--theta-o": theta_o, "--phi": phi})
    elif kind == TABLE:
        refuse(out, {"--scene": scene, "--lights": lights, "--resolution": resolution})
    else:
        raise ValueError(f"File `{out}` must end in .csv (table) or .exr (image).")
    require_writable(out.parent)
    brdffit.enable_compilation_cache()
    names = tuple(words(channels)) if channels else ()
    brdf = saved_or_named(model, assignments(settings, "--set"), len(names) or None)
    errors = brdffit.Noise(noise, additive, seed)
    truth = provenance(brdf, errors)

    if kind == IMAGE:
        view = scene_or_sphere(scene, lights, resolution)
        samples = brdffit.simulate_image(brdf, view, errors)
        samples = dataclasses.replace(samples, channels=names or samples.channels)
        out.parent.mkdir(parents=True, exist_ok=True)
        sphere.save(samples, view, out, truth)
        count, written = len(samples), [out, *map(out.with_suffix, (".toml", ".png"))]
    else:
        goniometer = brdffit.Goniometer(
            numbers(theta_i or THETA_I, "--theta-i"),
            numbers(theta_o or THETA_O, "--theta-o"),
            numbers(phi or PHI, "--phi"),
        )
        data = brdffit.simulate_measurement(brdf, goniometer, errors, out.stem)
        data = dataclasses.replace(data, channels=names or data.channels)
        origin = "simulated by brdffit, not measured"
        out.parent.mkdir(parents=True, exist_ok=True)
        table.save(data, out, {"origin": origin, "truth": json.dumps(truth)})
        count, written = len(data), [out]

    if as_json:
        files = [str(path) for path in written]
        console.print_json({"truth": truth, "samples": count, "files": files})
    else:
        what = "pixels" if kind == IMAGE else "pairs of directions"
        console.print_line(f"Simulated {truth['model']} at {count} {what}.")
        console.print_written(written)
