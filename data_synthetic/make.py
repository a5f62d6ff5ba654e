"""Write every file of this folder, and the bundled example, from manifest.toml.

python data_synthetic/make.py
"""

import json
import tomllib
from pathlib import Path
from typing import Any

from brdffit.catalogue import from_description
from brdffit.render import (
    Noise,
    provenance,
    simulate_image,
    simulate_measurement,
)
from brdffit.scene import Directional, Goniometer, Orthographic, Scene, Sphere
from brdffit.writers import sphere, table

HERE = Path(__file__).parent
MANIFEST = tomllib.loads((HERE / "manifest.toml").read_text(encoding="utf-8"))


def make_sphere(entry: dict[str, Any], folder: Path) -> Path:
    """Write one image with its sidecar and preview."""
    brdf = from_description(MANIFEST["materials"][entry["material"]])
    lights = tuple(
        Directional(**light) for light in MANIFEST["lights"][entry["lights"]]
    )
    scene = Scene(Orthographic(entry["resolution"]), (Sphere(),), lights)
    path = folder / entry["file"]
    sphere.save(simulate_image(brdf, scene), scene, path, provenance(brdf))
    return path


def make_table(entry: dict[str, Any], folder: Path) -> Path:
    """Write one goniometer's table, its truth in the header."""
    brdf = from_description(MANIFEST["materials"][entry["material"]])
    goniometer = Goniometer(**MANIFEST["goniometers"][entry["goniometer"]])
    noise = Noise(**entry["noise"])
    measurement = simulate_measurement(brdf, goniometer, noise, entry["name"])
    comments = {
        "origin": "simulated by brdffit, not measured; data_synthetic/manifest.toml",
        "truth": json.dumps(provenance(brdf, noise)),
        "unit": "f_r in 1/sr; sigma is the standard deviation of the noise",
    }
    path = (folder / entry["file"]).resolve()
    table.save(measurement, path, comments)
    return path


def main() -> None:
    """Write all files and say how large they are."""
    made = [make_sphere(entry, HERE) for entry in MANIFEST["spheres"]]
    made += [make_table(entry, HERE) for entry in MANIFEST["tables"]]
    for path in made:
        print(f"{path.stat().st_size:>9,} bytes  {path.name}")


if __name__ == "__main__":
    main()
