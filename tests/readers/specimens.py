"""A small valid file of every format, for tests that hold for all readers."""

import struct

import numpy as np

from brdffit import MODELS, half_difference, images
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


def exr_stack(folder):
    """The same sphere lit from two sides."""
    path = folder / "specimen_stack"
    path.mkdir()
    for name, x in (("a", 0.6), ("b", -0.6)):
        scene = lit_sphere(12, [(x, 0, 0.8)])
        samples = simulate_image(MODELS["lambert"](), scene)
        pixels = samples.pixels.images(np.asarray(samples.value), 0.0)[0]
        images.write(path / f"{name}.exr", pixels)
        save_scene(scene, path / f"{name}.toml")
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


def lighttools(folder, content="Monochrome"):
    """Two incidences, a transmission block to be left out, two wavelengths or XYZ."""
    azimuth, radial = (0, 90, 180, 270), (0, 30, 60)
    lines = ["# a comment", "Symmetry Asymmetric", f"SpectralContent {content}"]
    lines += ["ScatterAzimuth 4", "0 90 180 270", "ScatterRadial 3", "0 30 60"]
    lines += ["DataBegin"]
    names = ["Wavelength 450", "Wavelength 550"]
    if content == "XYZ":
        names = [f"TristimulusValue Tris{axis}" for axis in "XYZ"]
    for kind in ("BRDF", "BTDF"):
        for aoi in (0, 30):
            for index, name in enumerate(names):
                lines += [f"AOI {aoi}", "POI 0", "Side Front", name]
                lines += [f"ScatterType {kind}", "TIS 0.1"]
                start = index + 1 + aoi / 1e3 + (10 if kind == "BTDF" else 0)
                lines += [
                    " ".join(f"{start + a / 1e6 + r / 1e8:.9e}" for r in radial)
                    for a in azimuth
                ]
    path = folder / "specimen_lt.bsdf"
    path.write_text("\n".join([*lines, "DataEnd"]) + "\n")
    return path


def astm(folder, unit=1.0, names="R,G,B"):
    lines = ["SYSTEM none", "NUM_POINTS 4", f"VARS theta_i,phi_i,theta_s,phi_s,{names}"]
    for theta_s in (0.1, 0.5, 1.0, 1.2):
        angles = ",".join(f"{a * unit:.6f}" for a in (0.5, 0.0, theta_s, np.pi))
        lines.append(f"{angles},{theta_s:.6f},{2 * theta_s:.6f},{3 * theta_s:.6f}")
    path = folder / "specimen.astm"
    path.write_text("\n".join(lines) + "\n")
    return path


def nist_ptfe(folder):
    others = [f"f_r{r}{c}/f_r11" for r in "1234" for c in "1234" if r + c != "11"]
    lines = [",".join(["lambda,thetai,phi,thetar,phir,f_r11", *others])]
    for theta_r in (10, 45, 80):
        for phi_r in (0, 90, 180):
            start = f"0.532,-45,0,{theta_r},{phi_r},{0.3 + theta_r / 1e3 + phi_r / 1e6}"
            lines.append(start + ",0.01" * 15)
    path = folder / "specimen_nist.csv"
    path.write_text("\r\n".join(lines) + "\r\n")
    return path


def curet(folder):
    path = folder / "specimen_curet"
    path.mkdir()
    rng = np.random.default_rng(0)
    theta = rng.uniform(0, 1.4, (205, 2))
    phi = rng.uniform(-3, 3, (205, 2))
    angles = np.stack([theta[:, 0], phi[:, 0], theta[:, 1], phi[:, 1]], axis=1)
    with (path / "table.txt").open("w") as stream:
        for index, row in enumerate(angles):
            stream.write(f"{index + 1} " + " ".join(f"{a:.6f}" for a in row) + "\n")
    with (path / "abrdf.dat").open("w") as stream:
        for sample in range(3):
            values = rng.uniform(0.1, 0.3, 205)
            values[0] = -0.01
            words = " ".join(f"{v:.3f}" for v in values)
            stream.write(f"{sample + 1} {words}\n")
    return path


def merl(folder):
    """The only specimen of full size, 35 MB: the format knows one size."""
    path = folder / "specimen.binary"
    stored = np.full((3, half_difference.COUNT), 150.0)
    stored[:, 7] = -1
    with path.open("wb") as stream:
        np.array(half_difference.SHAPE, "<i4").tofile(stream)
        stored.tofile(stream)
    return path


def tensor_file(path, fields):
    """Write arrays as a tensor file."""
    kinds = {np.dtype("u1"): 1, np.dtype("u4"): 5, np.dtype("f4"): 10}
    size = 18 + sum(2 + len(n) + 11 + 8 * a.ndim for n, a in fields.items())
    head, body = [b"tensor_file\0", struct.pack("<BBI", 1, 0, len(fields))], []
    for name, array in fields.items():
        head.append(struct.pack("<H", len(name)) + name.encode())
        head.append(struct.pack("<HBQ", array.ndim, kinds[array.dtype], size))
        head.append(struct.pack(f"<{array.ndim}Q", *array.shape))
        body.append(array.tobytes())
        size += array.nbytes
    path.write_bytes(b"".join([*head, *body]))
    return path


def rgl(folder, azimuths=1, wavelengths=(), parts=1):
    """Random smooth tables; isotropic with one azimuth of incidence."""
    rng = np.random.default_rng(1)
    theta_i = np.linspace(0, np.pi / 2, 4).astype("f4")
    phi_i = np.linspace(-np.pi, -np.pi + 2 * np.pi / parts, azimuths).astype("f4")
    phi_i = phi_i if azimuths > 1 else np.zeros(1, "f4")
    channels = len(wavelengths) or 3

    def table(*shape):
        array = rng.uniform(0.5, 1.5, shape).astype("f4")
        if parts == 1:
            array[-1] = array[0]  # azimuths -pi and pi are the same
        return array

    grid = (azimuths, len(theta_i))
    fields = {
        "description": np.frombuffer(b"a specimen", "u1"),
        "phi_i": phi_i,
        "theta_i": theta_i,
        "sigma": table(4 if azimuths > 1 else 2, 8),
        "ndf": table(4, 8),
        "vndf": table(*grid, 8, 8),
        "luminance": table(*grid, 6, 6),
        "jacobian": np.ones(1, "u1"),
        "spectra" if wavelengths else "rgb": table(*grid, channels, 6, 6),
    }
    if wavelengths:
        fields["wavelengths"] = np.array(wavelengths, "f4")
    return tensor_file(folder / "specimen_rgl.bsdf", fields)


def utia(folder):
    path = folder / "specimen.bin"
    rows = np.arange(288.0)
    image = 0.1 + rows[:, None] / 1e3 + rows / 1e6
    np.stack([image, 2 * image, 3 * image]).tofile(path)
    return path


def files_of(path):
    """All files that belong to a specimen."""
    if path.is_dir():
        return sorted(path.iterdir())
    return [path, *path.parent.glob(f"{path.stem}.toml")]


SPECIMENS = {
    make.__name__: make
    for make in (
        table,
        fred,
        zemax,
        lighttools,
        astm,
        nist_ptfe,
        curet,
        merl,
        rgl,
        utia,
        sphere_exr,
        sphere_photos,
        exr_stack,
    )
}
