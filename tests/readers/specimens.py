"""A small valid file of every format, for tests that hold for all readers."""

import numpy as np

from brdffit import MODELS, images
from brdffit.render import simulate_image
from brdffit.samples import Measurement
from brdffit.scene import lit_sphere, save_scene
from brdffit.writers import table as table_writer


def measurement(count=40, channels=3, seed=0, dtype=np.float64):
    """Random directions above the horizon with positive values."""
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(2, count, 3))
    w[..., 2] = np.abs(w[..., 2]) + 0.1
    w /= np.linalg.norm(w, axis=-1, keepdims=True)
    f_r = rng.lognormal(size=(count, channels))
    return Measurement(
        wi=w[0].astype(dtype), wo=w[1].astype(dtype), f_r=f_r.astype(dtype)
    )


def table(folder):
    path = folder / "specimen.csv"
    table_writer.save(measurement(), path)
    return path


def fred(folder, lights=(10, 50), thetas=(0, 30, 60), phis=(0, 90, 180)):
    """A value says where it stands: theta_i, theta_o, phi as digits."""
    lines = ["type bsdf_data", "format angles=deg bsdf=value scale=1"]
    for theta_i in lights:
        lines.append(f"{theta_i}\t0")
        lines += [
            f"{t}\t{p}\t{1 + theta_i / 1e2 + t / 1e4 + p / 1e7:.6f}"
            for t in thetas
            for p in phis
        ]
    path = folder / "specimen.txt"
    path.write_text("\n".join(lines) + "\n")
    return path


def zemax(folder, content="Monochrome", rotations=(0,)):
    """Incidence 0 and 40 degrees; one cell without data in each block."""
    azimuth, radial, incidence = (0, 90, 180, 270), (0, 10, 20), (0, 40)
    lines = ["# a comment", "Source\tMeasured", "Symmetry\tAsymmetrical4D"]
    lines += [f"SpectralContent\t{content}", "ScatterType\tBRDF"]
    angles = {
        "SampleRotation": rotations,
        "AngleOfIncidence": incidence,
        "ScatterAzimuth": azimuth,
        "ScatterRadial": radial,
    }
    for label, values in angles.items():
        lines += [f"{label}\t{len(values)}", "\t".join(map(str, values))]
    names = ["Monochrome"] if content == "Monochrome" else list("XYZ")
    for index, name in enumerate(names):
        lines += ["", name if len(name) > 1 else f"Tristimulus{name}", "DataBegin"]
        for turn in rotations:
            for theta in incidence:
                lines.append("TIS\t0.05")
                block = [
                    [
                        index + 1 + turn / 1e3 + theta / 1e5 + a / 1e8 + r / 1e9
                        for r in radial
                    ]
                    for a in azimuth
                ]
                block[3][2] = 0
                lines += ["\t".join(f"{v:.9e}" for v in row) for row in block]
        lines.append("DataEnd")
    path = folder / "specimen.bsdf"
    path.write_text("\n".join(lines) + "\n")
    return path


def sphere_exr(folder, resolution=12):
    scene = lit_sphere(resolution)
    samples = simulate_image(MODELS["lambert"](), scene)
    path = folder / "specimen.exr"
    images.write(path, samples.pixels.images(np.asarray(samples.value), 0.0)[0])
    save_scene(scene, path.with_suffix(".toml"))
    return path


def sphere_photos(folder, resolution=12):
    """Three photographs of a diffuse ball of albedo 0.5."""
    path = folder / "specimen_photos"
    path.mkdir()
    lights = np.array([[0, 0, 1], [0.6, 0, 0.8], [0, 0.6, 0.8]])
    intensities = np.array([[1, 0.8, 0.6], [0.5, 0.5, 0.5], [0.9, 1, 0.9]])
    centre = (2 * np.arange(resolution) + 1) / resolution - 1
    x, y = np.meshgrid(centre, -centre)
    inside = np.hypot(x, y) < 1
    normal = np.stack([x, y, np.sqrt(np.maximum(1 - x * x - y * y, 0))], axis=-1)
    for index, (light, intensity) in enumerate(zip(lights, intensities, strict=True)):
        shade = np.maximum(normal @ light, 0)[..., None] * inside[..., None]
        images.write(path / f"{index:03}.png", (0.5 * shade * intensity))
    images.write(path / "mask.png", inside[..., None].astype(np.float32))
    np.savetxt(path / "light_directions.txt", lights, fmt="%.6f")
    np.savetxt(path / "light_intensities.txt", intensities, fmt="%.4f")
    return path


SPECIMENS = {
    make.__name__: make for make in (table, fred, zemax, sphere_exr, sphere_photos)
}
